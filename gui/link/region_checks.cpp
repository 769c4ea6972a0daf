#include "gui/link/region_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tact {
namespace {

template <std::size_t N>
bool finite(const double (&values)[N]) noexcept {
    return std::all_of(values, values + N, [](double v) { return std::isfinite(v); });
}
template <std::size_t N>
bool unit_quaternion(const double (&q)[N]) noexcept {
    static_assert(N == 4);
    if (!finite(q)) return false;
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return square > 0.98 && square < 1.02;
}
template <std::size_t N>
bool near(const double (&p_m)[N]) noexcept {
    return finite(p_m) && std::all_of(p_m, p_m + N, [](double v) { return std::fabs(v) < 1e3; });
}
template <std::size_t N>
bool ended(const char (&text)[N]) noexcept {
    return std::memchr(text, 0, N) != nullptr;
}
bool rate(double hz) noexcept { return std::isfinite(hz) && hz >= 0.0 && hz < 1e9; }
bool fraction(float part) noexcept { return part >= 0.0F && part <= 1.0F; }
bool duration(std::int64_t ns) noexcept { return ns >= -1 && ns < 1'000'000'000'000'000; }

}  // namespace

bool sensible(const BodiesTopic& b) noexcept {
    if (b.count > kBodiesMax || (b.active != kNoBody && b.count > 0 && b.active >= b.count)) return false;
    if (!(b.pull_n >= 0.0F && b.pull_n < 1e3F)) return false;
    return std::all_of(b.body, b.body + b.count, [](const BodyPlace& place) {
        return near(place.pos_model_m) && unit_quaternion(place.quat_model_body_xyzw);
    });
}

bool sensible(const ShapesTopic& s) noexcept {
    const auto within = [](float v, float most) { return v >= 0.0F && v <= most; };
    if (!within(s.rmsd_m, 1e-3F) || !within(s.strain, 1e3F) || !within(s.strain_most, 1e3F) || s.bends > 1)
        return false;
    return std::all_of(s.body, s.body + kBodiesMax, [](const ShapeRow& row) {
        return std::all_of(row.amplitude_m, row.amplitude_m + kShapeModesMax,
                           [](float a) { return std::fabs(a) < 1e-3F; });
    });
}

bool sensible(const ToolTopic& t) noexcept {
    return near(t.pos_world_m) && unit_quaternion(t.quat_world_tool_xyzw) && near(t.force_world_n) &&
           near(t.torque_world_n_m) && near(t.force_model_n) && near(t.velocity_world_m_s);
}

bool sensible(const TouchTopic& t) noexcept {
    if (!near(t.probe_model_m) || !near(t.proxy_model_m) || t.planes > kTouchPlanesMax ||
        t.state > TouchState::lagging || t.regime > TouchRegime::brute ||
        !(t.radius_model_m >= 0.0 && t.radius_model_m < 1e3))
        return false;
    for (const float v : {t.detail_radius_model_m, t.detail_width, t.detail_error_far, t.deviation_model_m,
                          t.turn_s, t.turn_predicted_s})
        if (!(v >= 0.0F && v < 1e4F)) return false;
    if (t.detail > 2 || t.detail_shape > DetailShape::multiple_frustum) return false;
    for (std::uint32_t i = 0; i < t.planes; ++i) {
        const float* const n = t.normal_model[i];
        const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        if (!(square > 0.98F && square < 1.02F && t.push_n[i] >= 0.0F && t.push_n[i] < 1e3F)) return false;
    }
    return true;
}

bool sensible(const DrillTopic& t) noexcept {
    // NaN fails every comparison.
    const auto within = [](float v, float most) { return v >= 0.0F && v <= most; };
    if (!(t.level_m3 >= 0.0 && t.level_m3 < 1.0) || !within(t.burr_rad_s_most, 1e6F) ||
        !within(t.irrigation_m3_s_most, 1.0F) || !within(t.suction_m3_s_most, 1.0F))
        return false;
    return std::all_of(t.hand, t.hand + kDrillHands, [&within](const DrillHand& h) {
        if (h.kind == DrillKind::none) return true;
        return h.kind <= DrillKind::suction_tube && h.shape <= DrillShape::cone &&
               h.grit <= DrillGrit::diamond && near(h.pos_model_m) &&
               unit_quaternion(h.quat_model_tool_xyzw) && h.radius_m > 0.0F && within(h.radius_m, 1.0F) &&
               within(h.length_m, 1.0F) && within(h.tip_radius_m, 1.0F) && within(h.shaft_radius_m, 1.0F) &&
               within(h.shaft_length_m, 1.0F) && within(h.burr_rad_s, 1e6F) && within(h.suction, 1.0F) &&
               within(h.irrigation, 1.0F) && within(h.depth, 2.0F) && within(h.elastic_n, 1e6F) &&
               within(h.force_n, 1e6F);
    });
}

bool sensible(const HeadTopic& h) noexcept {
    return near(h.pos_screen_m) && unit_quaternion(h.quat_screen_head_xyzw) && near(h.velocity_screen_m_s) &&
           near(h.angular_screen_rad_s) && h.state <= 2 && h.quality >= 0.0 && h.quality <= 1.0;
}

bool sensible(const TrackerTopic& t) noexcept {
    return duration(t.age_ns) && rate(t.rate_hz) && t.state <= 2 && t.link <= 4;
}

bool sensible(const DevicesTopic& t) noexcept {
    return std::all_of(t.hand, t.hand + kDeviceHands, [](const DeviceHand& d) {
        const auto within = [](float v, float most) { return v >= 0.0F && v <= most; };
        return duration(d.age_ns) && duration(d.age_ns_most) && within(d.heat, 1e9F) &&
               within(d.force_n_max, 1e6F) && within(d.force_n_continuous, 1e6F) &&
               std::fabs(d.winding_c) <= 1e4F && within(d.winding_c_max, 1e4F) && d.valid <= 1 && d.read <= 3;
    });
}

// The counts sum to the total, and each is bounded: sums cannot overflow.
bool sensible(const LatenessTopic& l) noexcept {
    constexpr std::uint64_t kMost = 1'000'000'000'000'000;
    std::uint64_t sum = 0;
    for (const std::uint64_t n : l.counts) {
        if (n > kMost) return false;
        sum += n;
    }
    return sum == l.total && l.max_ns <= kMost && l.taken_at_ns >= 0;
}

bool sensible(const HealthTopic& h) noexcept {
    return rate(h.force_rate_hz) && rate(h.force_rate_mean_hz) && rate(h.goal_hz) &&
           std::isfinite(h.gui_fps) && duration(h.period_ns) && duration(h.lateness_p50_ns) &&
           duration(h.lateness_p99_ns) && duration(h.lateness_max_ns) && duration(h.cycle_cost_p50_ns) &&
           duration(h.cycle_cost_max_ns) && fraction(h.recomputed_fraction_mean) &&
           fraction(h.recomputed_fraction_least) && fraction(h.rested) && duration(h.delay_p50_ns) &&
           duration(h.delay_p99_ns) && std::isfinite(h.stiffness_n_m_max) && std::isfinite(h.model_n_m) &&
           std::isfinite(h.model_n_m_rad) && std::isfinite(h.torque_n_m_rad_max) &&
           std::isfinite(h.field_gain) && duration(h.model_ns_max) && fraction(h.deadline_miss_share) &&
           std::isfinite(h.force_error_n_p50) && std::isfinite(h.force_step_n_max) &&
           std::isfinite(h.level_settled_s) && h.state <= static_cast<std::uint8_t>(RunState::fault);
}

bool sensible(const LevelsTopic& l) noexcept {
    if (l.count > kPathsMax || !rate(l.goal_hz) || !rate(l.rate_hz) ||
        !rate(static_cast<double>(l.display_goal_hz)) || !ended(l.law))
        return false;
    return std::all_of(l.path, l.path + l.count, [](const PathLevel& p) {
        return ended(p.path) && std::isfinite(p.level) && p.level >= 0.0F && p.level <= 1.0F &&
               std::isfinite(p.floor) && std::isfinite(p.cost_s) && std::isfinite(p.error);
    });
}

bool sensible(const MarkTopic& m) noexcept { return near(m.pos_model_m); }

// The bounds are those within which tact-replay keeps what it publishes.
bool sensible(const ReplayTopic& r) noexcept {
    constexpr double kMostS = 1e9;
    constexpr std::int64_t kMostNs = 4'000'000'000'000'000'000;
    const auto time = [](double s) { return s >= 0.0 && s <= kMostS; };
    return time(r.at_s) && time(r.duration_s) && r.speed >= TimelineTopic::kSpeedLeast &&
           r.speed <= TimelineTopic::kSpeedMost && r.seek_share >= 0.0 && r.seek_share <= 1.0 &&
           r.act <= static_cast<std::uint8_t>(ReplayAct::ended) && r.exact <= 1 && r.whole <= 1 &&
           r.plays <= 1 && r.can_run <= 1 && r.taken_at_ns >= 0 && r.shown_ns >= 0 && r.shown_ns <= kMostNs &&
           ended(r.name);
}

bool sensible(const ReplayMarks& m) noexcept {
    return m.count <= ReplayMarks::kMost && std::all_of(m.mark, m.mark + m.count, [](const ReplayMark& mark) {
               return std::isfinite(mark.at_s) && mark.grade <= 2;
           });
}

bool sensible(const RecordersTopic& r) noexcept { return r.recorders <= 64 && r.flights <= 64; }

const PathLevel* find_path(const LevelsTopic& levels, const char* path) noexcept {
    const PathLevel* const end = levels.path + std::min<std::size_t>(levels.count, kPathsMax);
    const PathLevel* const found = std::find_if(levels.path, end, [path](const PathLevel& p) {
        return std::strncmp(p.path, path, kPathNameMax) == 0;
    });
    return found == end ? nullptr : found;
}

}  // namespace tact
