// The signal that asks the window to end: SIGINT, SIGTERM or SIGHUP.
#pragma once

namespace tact {

void catch_stop_signals();
[[nodiscard]] int stop_signal() noexcept;  // 0: none yet

}  // namespace tact
