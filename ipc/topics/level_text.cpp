#include "ipc/topics/level_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "ipc/topics/text.hpp"

namespace tact {
namespace {

constexpr float kFull = 0.999F;

// A level below the top stays limited by what last moved it, up or down.
std::string limit_text(const PathLevel& p) {
    const auto reason = static_cast<LevelReason>(p.reason);
    switch (reason) {
        case LevelReason::cost_low:
        case LevelReason::cost_high:
            return "step cost limit";
        case LevelReason::start:
        case LevelReason::hold:
            return p.haptic != 0 ? "step cost limit" : level_reason_text(reason);
        case LevelReason::deadline_missed:
            return "deadline missed";
        case LevelReason::rate_low:
        case LevelReason::rate_high:
            return "force rate limit";
        case LevelReason::display_low:
        case LevelReason::display_high:
            return "frame rate limit";
        default:
            return level_reason_text(reason);
    }
}

std::string duration_text(double s) {
    std::array<char, 32> text{};
    if (s < 10.0)
        std::snprintf(text.data(), text.size(), "%.1f s", s);
    else if (s < 600.0)
        std::snprintf(text.data(), text.size(), "%.0f s", s);
    else
        std::snprintf(text.data(), text.size(), "%.0f min", s / 60.0);
    return text.data();
}

}  // namespace

// A hand does not feel less.
constexpr double kErrorShown_n = 0.0005;

std::string level_status_text(const PathLevel& p, std::int64_t now_ns) {
    std::string text = p.level >= kFull ? "full detail" : limit_text(p);
    const double since_s = 1e-9 * static_cast<double>(now_ns - p.changed_at_ns);
    if (p.level < kFull && p.changed_at_ns > 0 && since_s >= 0.0) text += ", " + duration_text(since_s);
    if (p.haptic != 0 && p.error >= kErrorShown_n && std::isfinite(p.error) && p.error < 1e3) {
        std::array<char, 48> error{};
        std::snprintf(error.data(), error.size(), ", ±%.2g N", p.error);
        text += error.data();
    }
    return text;
}

}  // namespace tact
