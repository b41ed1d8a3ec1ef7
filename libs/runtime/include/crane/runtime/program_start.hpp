#pragma once
/// Start of every program: standard descriptors and signals.
namespace crane::runtime {

/// Call first in main().
/// - Opens each of the descriptors 0 to 2 that the caller has closed. Otherwise, the next file or socket of
///   the program would get this number, and every message of the program would be written into it.
///   Descriptor 0 becomes /dev/null for writing only, descriptors 1 and 2 become /dev/null for reading
///   only: every use fails with EBADF, so that a result that cannot be printed remains an error.
/// - A write beyond the file-size limit fails with an error message instead of SIGXFSZ.
void start_program() noexcept;

}  // namespace crane::runtime
