#pragma once
/// Signals that shut down a process.
namespace crane::runtime {

/// SIGINT, SIGTERM, SIGHUP and SIGQUIT set stop_requested(). The process then ends its loop, and the bridge
/// leaves its board at 0 V with closed brakes. SIGPIPE is ignored: a closed terminal must not end the loop.
/// SIGKILL, SIGABRT and SIGSEGV end the process at once; the watchdog output then stops toggling, and the
/// relay of the rig closes the brakes. @throws std::system_error
void install_stop_signals();
[[nodiscard]] bool stop_requested();

/// Requests that the kernel sends SIGTERM to this process when the process `parent` ends. Call after exec:
/// exec clears an earlier request when the program has file capabilities.
/// @throws std::system_error; std::runtime_error when `parent` has ended already
void end_with_parent(int parent);

}  // namespace crane::runtime
