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
            return "limited by step cost";
        case LevelReason::start:
        case LevelReason::hold:
            return p.haptic != 0 ? "limited by step cost" : level_reason_text(reason);
        case LevelReason::deadline_missed:
            return "lowered after a deadline miss";
        case LevelReason::rate_low:
        case LevelReason::rate_high:
            return "limited by the force rate";
        case LevelReason::picture_low:
        case LevelReason::picture_high:
            return "limited by the frame rate";
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

std::string level_status_text(const PathLevel& p, std::int64_t now_ns) {
    std::string text = p.level >= kFull ? "full detail" : limit_text(p);
    const double since_s = 1e-9 * static_cast<double>(now_ns - p.changed_at_ns);
    if (p.level < kFull && p.changed_at_ns > 0 && since_s >= 0.0) text += " for " + duration_text(since_s);
    if (p.haptic != 0 && p.error > 0.0 && std::isfinite(p.error) && p.error < 1e3) {
        std::array<char, 48> error{};
        std::snprintf(error.data(), error.size(), ", error %.3f N", p.error);
        text += error.data();
    }
    return text;
}

}  // namespace tact
