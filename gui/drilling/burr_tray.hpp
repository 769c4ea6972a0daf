// The burrs that the window offers, as on a tray for mastoid surgery, and the commands that change burr and drives.
//
// Thread   any
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "gui/dashboard/dashboard_state.hpp"
#include "ipc/topics/drill.hpp"

namespace tact {

struct TrayBurr {
    DrillGrit grit = DrillGrit::cutting;
    DrillShape shape = DrillShape::sphere;
    double diameter_m = 0.0, length_m = 0.0;  // length_m: of the head, of a cylinder or cone
};

inline constexpr auto kBurrTray = [] {
    using enum DrillGrit;
    using enum DrillShape;
    return std::to_array<TrayBurr>({
        {cutting, sphere, 7e-3, 0.0},
        {cutting, sphere, 6e-3, 0.0},
        {cutting, sphere, 5e-3, 0.0},
        {cutting, sphere, 4e-3, 0.0},
        {cutting, sphere, 3e-3, 0.0},
        {cutting, sphere, 2e-3, 0.0},
        {cutting, sphere, 1e-3, 0.0},
        {diamond, sphere, 6e-3, 0.0},
        {diamond, sphere, 5e-3, 0.0},
        {diamond, sphere, 4e-3, 0.0},
        {diamond, sphere, 3e-3, 0.0},
        {diamond, sphere, 2.3e-3, 0.0},
        {diamond, sphere, 1.8e-3, 0.0},
        {diamond, sphere, 1.4e-3, 0.0},
        {diamond, sphere, 1e-3, 0.0},
        {cutting, cylinder, 3e-3, 8e-3},
        {cutting, cone, 3e-3, 8e-3},
    });
}();

// The next larger (step 1) or smaller (-1) one of its grit and shape; the same where there is none.
[[nodiscard]] constexpr TrayBurr next_burr(const TrayBurr& now, int step) {
    constexpr double kSame = 1e-5;
    TrayBurr best = now;
    for (const TrayBurr& b : kBurrTray) {
        if (b.grit != now.grit || b.shape != now.shape) continue;
        const double way_m = step * (b.diameter_m - now.diameter_m);
        if (way_m < kSame) continue;
        if (best.diameter_m == now.diameter_m || way_m < step * (best.diameter_m - now.diameter_m)) best = b;
    }
    return best;
}

// The ball of the other grit that is nearest in size.
[[nodiscard]] constexpr TrayBurr other_grit(const TrayBurr& now) {
    TrayBurr best;
    const auto off = [&now](const TrayBurr& b) {
        return b.diameter_m < now.diameter_m ? now.diameter_m - b.diameter_m : b.diameter_m - now.diameter_m;
    };
    for (const TrayBurr& b : kBurrTray)
        if (b.grit != now.grit && b.shape == DrillShape::sphere &&
            (best.diameter_m == 0.0 || off(b) < off(best)))
            best = b;
    return best;
}

[[nodiscard]] inline Request burr_request(const TrayBurr& b) {
    return {CommandKind::set_burr,
            b.diameter_m,
            {},
            static_cast<std::uint32_t>(b.shape) | static_cast<std::uint32_t>(b.grit) << 8U,
            b.length_m};
}

}  // namespace tact
