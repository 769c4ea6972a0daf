// One line about a detail level: what limits it, for how long, and at which error.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/topics/levels.hpp"

namespace tact {

// "full detail", "step cost limit, 12 s, ±0.013 N". now_ns: of the clock of changed_at_ns.
// Any values may come in; what is not plausible is left out.
[[nodiscard]] std::string level_status_text(const PathLevel& level, std::int64_t now_ns);

}  // namespace tact
