#pragma once
/// What every program does first.
namespace crane::runtime {

/// Call first in main().
/// - Opens each of the descriptors 0 to 2 that the caller has closed. Otherwise, the next file or socket of
///   the program would get this number, and every message of the program would be written into it. The
///   descriptor then leads to /dev/null, opened in the direction that its use does not need: a program reads
///   no input, and a result that cannot be printed remains an error (EBADF).
/// - A write beyond the file-size limit fails with an error message instead of SIGXFSZ.
void start_program() noexcept;

}  // namespace crane::runtime
