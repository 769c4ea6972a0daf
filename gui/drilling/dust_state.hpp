// Where the bone is that was removed while the window was open.
//
// Thread   any
#pragma once

#include "gui/drilling/drilling_panel.hpp"
#include "gui/drilling/particles.hpp"

namespace tact {

[[nodiscard]] inline DrillingState::Dust dust_of(const Ledger& l, double level_m3) {
    const auto m3 = [&](std::uint64_t levels) { return level_m3 * static_cast<double>(levels); };
    return {.here_m3 = m3(l.carried + l.pooled),
            .sucked_m3 = m3(l.sucked),
            .flown_m3 = m3(l.left),
            .buried_m3 = m3(l.buried)};
}

}  // namespace tact
