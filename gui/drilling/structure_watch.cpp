#include "gui/drilling/structure_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

HeadBalls head_balls(const DrillHand& h, double world_per_model) {
    HeadBalls head;
    if (h.kind == DrillKind::none) return head;
    const Vec3 at(h.pos_model_m[0], h.pos_model_m[1], h.pos_model_m[2]);
    const double* const q = h.quat_model_tool_xyzw;
    const Vec3 axis = Quat(q[3], q[0], q[1], q[2]).normalized() * Vec3::UnitZ();
    const auto radius = static_cast<double>(h.radius_m), length = static_cast<double>(h.length_m),
               tip = h.shape == DrillShape::cone ? static_cast<double>(h.tip_radius_m) : radius;
    const double low = tip - 0.5 * length, high = 0.5 * length - radius;
    const bool ball = h.kind == DrillKind::suction_tube || h.shape == DrillShape::sphere || high <= low;
    head.count = ball ? 1 : HeadBalls::kMax;
    for (std::size_t i = 0; i < head.count; ++i) {
        const double s = static_cast<double>(i) / (HeadBalls::kMax - 1);
        head.centre_m[i] = ball ? at : Vec3(at + std::lerp(low, high, s) / world_per_model * axis);
        head.radius_m[i] = (ball ? radius : std::lerp(tip, radius, s)) / world_per_model;
    }
    return head;
}

HeadBalls moved(const HeadBalls& head, const Vec3& way_m) {
    HeadBalls there = head;
    for (std::size_t i = 0; i < there.count; ++i) there.centre_m[i] += way_m;
    return there;
}

double distance_m(const DistanceField& field, const HeadBalls& head, double world_per_model) {
    double least = 1e9;
    for (std::size_t i = 0; i < head.count; ++i)
        least = std::min(least, field.distance_m(head.centre_m[i]) - head.radius_m[i]);
    return least * world_per_model;
}

Vec3 towards_structure(const DistanceField& field, const HeadBalls& head) {
    std::size_t nearest = 0;
    const auto away_m = [&](std::size_t i) { return field.distance_m(head.centre_m[i]) - head.radius_m[i]; };
    for (std::size_t i = 1; i < head.count; ++i)
        if (away_m(i) < away_m(nearest)) nearest = i;
    Vec3 falls = Vec3::Zero();
    for (int axis = 0; axis < 3 && head.count > 0; ++axis) {
        const Vec3 step_m = field.spacing_m * Vec3::Unit(axis);
        falls[axis] = field.distance_m(head.centre_m[nearest] - step_m) -
                      field.distance_m(head.centre_m[nearest] + step_m);
    }
    const double size = falls.norm();
    return size > 0.0 ? Vec3(falls / size) : Vec3(Vec3::Zero());
}

std::span<const StructureWatch::Reading> StructureWatch::look(const DrillTopic& drill, std::size_t hand) {
    Hand& h = hand_[hand];
    const HeadBalls head = head_balls(drill.hand[hand], world_per_model_);
    if (head.count == 0) {
        h.known = false;
        return {};
    }
    const double dt_s = 1e-9 * static_cast<double>(drill.taken_at_ns - h.at_ns);
    const bool goes_on = h.known && dt_s >= 0.0 && dt_s < 1.0;
    h.reading.resize(fields_.size());
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        Reading& r = h.reading[i];
        const double now_m = distance_m(fields_[i], head, world_per_model_);
        r.label = fields_[i].label;
        if (!goes_on)
            r.closing_m_s = 0.0;
        else if (dt_s > 0.0)
            r.closing_m_s +=
                (1.0 - std::exp(-dt_s / kSmoothS)) * ((r.distance_m - now_m) / dt_s - r.closing_m_s);
        r.distance_m = now_m;
        r.towards_model = towards_structure(fields_[i], head);
    }
    h.known = true;
    h.at_ns = drill.taken_at_ns;
    return h.reading;
}

}  // namespace tact
