#pragma once
/// How a process is told to end in order.
namespace crane::runtime {

/// SIGINT, SIGTERM, SIGHUP and SIGQUIT set stop_requested(): the process leaves its loop, and the bridge
/// leaves its board at 0 V with closed brakes. SIGPIPE is ignored: a closed terminal must not end a loop.
/// What cannot be caught or must not be survived (SIGKILL, SIGABRT, SIGSEGV) stops the watchdog output, and
/// the rig's relay closes the brakes. @throws std::system_error
void install_stop_signals();
[[nodiscard]] bool stop_requested();

/// Asks the kernel for SIGTERM when the process `parent` ends. To be asked for by the child itself: the
/// request of a parent between fork and exec is lost when the program has file capabilities.
/// @throws std::system_error; std::runtime_error when `parent` has ended already
void die_with(int parent);

}  // namespace crane::runtime
