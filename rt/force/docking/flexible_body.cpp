#include "rt/force/docking/flexible_body.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

// The first pass bends the points and empties the forces of the next, which the third projects.
constexpr std::size_t kPassesUntilKnown = 3;
constexpr double kStepMostS = 0.02;   // a pause of the machine must not bend a body far
constexpr double kStraightM = 1e-13;  // RMSD that is none
constexpr double kStillM_s = 1e-11;   // slower motion counts as rest

struct Range {
    std::size_t begin, end;
};

Range slice_of(std::size_t slice, std::size_t count) noexcept {
    return {slice * count / FlexibleBody::kSlices, (slice + 1) * count / FlexibleBody::kSlices};
}

double good_step_s(double step_s) noexcept { return step_s > 0.0 ? std::min(step_s, kStepMostS) : 0.0; }

}  // namespace

FlexibleBody::FlexibleBody(const std::vector<FlexibleParts>& parts,
                           const std::vector<std::vector<PointSet>>& levels)
    : parts_(parts), levels_(levels), bent_levels_(levels.size()) {
    std::size_t nodes = 0, points = 0;
    for (std::size_t s = 0; s < parts.size(); ++s) {
        if (!parts[s].bends()) continue;
        bent_levels_[s] = levels[s];
        for (PointSet& level : bent_levels_[s]) {
            level.radius_m += parts[s].shift_per_m * kRmsdMost_m;
            points = std::max(points, level.size());
        }
        nodes = std::max(nodes, parts[s].modes.nodes());
    }
    shift_.resize(nodes);
    for (NodeVectors& force : force_) force.resize(nodes);
    gradient_.resize(points / kSlices + 1);
}

const std::vector<PointSet>& FlexibleBody::levels(std::size_t structure) const noexcept {
    return bent_ && structure == structure_ ? bent_levels_[structure] : levels_[structure];
}

BodyShape* FlexibleBody::shape_of(std::uint32_t id) noexcept {
    BodyShape* unused = nullptr;
    for (BodyShape& shape : shapes_) {
        if (shape.id == id) return &shape;
        if (shape.id == 0 && unused == nullptr) unused = &shape;
    }
    return unused;
}

void FlexibleBody::hold(std::uint32_t id, std::size_t structure, bool flexible) noexcept {
    moved_ = false;
    if (!flexible) {  // those that nobody feels are straight at once
        for (BodyShape& shape : shapes_) {
            if (shape.id != id) shape.amplitude_m.fill(0.0F);
        }
    }
    if (id == 0 || !can_bend(structure)) {
        id_ = 0;
        bent_ = false;
        return;
    }
    BodyShape* const shape = shape_of(id);
    if (shape == nullptr) {  // as many shapes as bodies: forget_removed() was not called
        bent_ = false;
        return;
    }
    shape->id = id;
    const bool bends = flexible || shape->rmsd_m() > 0.0;
    if (id != id_ || (bends && !bent_)) {
        slice_ = passes_ = 0;
        drive_.fill(0.0);
        next_drive_.fill(0.0);
        strain_.restart(shape->amplitude_m);
    }
    id_ = id;
    structure_ = structure;
    bent_ = bends;
}

void FlexibleBody::shift_nodes(const FlexibleParts& parts) noexcept {
    const NormalModes& m = parts.modes;
    const Range r = slice_of(slice_, m.nodes());
    for (std::size_t n = r.begin; n < r.end; ++n) shift_.x[n] = shift_.y[n] = shift_.z[n] = 0.0F;
    for (std::size_t k = 0; k < m.count(); ++k) {
        const float a = now_m_[k];
        const float *x = &m.x[k * m.nodes()], *y = &m.y[k * m.nodes()], *z = &m.z[k * m.nodes()];
        for (std::size_t n = r.begin; n < r.end; ++n) {
            shift_.x[n] += a * x[n];
            shift_.y[n] += a * y[n];
            shift_.z[n] += a * z[n];
        }
    }
}

void FlexibleBody::bend_points(const FlexibleParts& parts, std::size_t structure) noexcept {
    for (std::size_t l = 0; l < levels_[structure].size(); ++l) {
        const PointSet& straight = levels_[structure][l];
        PointSet& bent = bent_levels_[structure][l];
        const Range r = slice_of(slice_, straight.size());
        for (std::size_t i = r.begin; i < r.end; ++i) {
            const std::uint32_t n = parts.node[l][i];
            bent.x_m[i] = straight.x_m[i] + shift_.x[n];
            bent.y_m[i] = straight.y_m[i] + shift_.y[n];
            bent.z_m[i] = straight.z_m[i] + shift_.z[n];
        }
    }
}

void FlexibleBody::end_pass(const FlexibleParts& parts) noexcept {
    slice_ = 0;
    if (passes_ < kPassesUntilKnown) ++passes_;
    drive_ = next_drive_;
    next_drive_.fill(0.0);
    now_ = 1 - now_;
    strain_.end_pass(parts, shift_, now_m_);
}

void FlexibleBody::sum_forces(const LevelBlend& blend, std::size_t level, double weight,
                              const Pose& T_model_body) noexcept {
    const PointSet& points = blend.levels[level];
    const Range r = slice_of(slice_, points.size());
    const std::size_t count = r.end - r.begin;
    const PointGradients each{
        {gradient_.x.data(), count}, {gradient_.y.data(), count}, {gradient_.z.data(), count}};
    static_cast<void>(blend.map_of(level).sum(points.view(r.begin, count), T_model_body, &each));
    const Eigen::Matrix3f to_body = (weight * T_model_body.q.toRotationMatrix().transpose()).cast<float>();
    NodeVectors& force = force_[now_];
    const std::vector<std::uint32_t>& node = parts_[structure_].node[level];
    for (std::size_t i = 0; i < count; ++i) {
        const float gx = gradient_.x[i], gy = gradient_.y[i], gz = gradient_.z[i];
        const std::uint32_t n = node[r.begin + i];
        force.x[n] += to_body(0, 0) * gx + to_body(0, 1) * gy + to_body(0, 2) * gz;
        force.y[n] += to_body(1, 0) * gx + to_body(1, 1) * gy + to_body(1, 2) * gz;
        force.z[n] += to_body(2, 0) * gx + to_body(2, 1) * gy + to_body(2, 2) * gz;
    }
}

// Forces of the last pass; leaves zeros for the next one.
void FlexibleBody::project_forces(const FlexibleParts& parts) noexcept {
    const NormalModes& m = parts.modes;
    NodeVectors& force = force_[1 - now_];
    const Range r = slice_of(slice_, m.nodes());
    for (std::size_t k = 0; k < m.count(); ++k) {
        const float *x = &m.x[k * m.nodes()], *y = &m.y[k * m.nodes()], *z = &m.z[k * m.nodes()];
        float sum = 0.0F;
        for (std::size_t n = r.begin; n < r.end; ++n)
            sum += force.x[n] * x[n] + force.y[n] * y[n] + force.z[n] * z[n];
        next_drive_[k] += static_cast<double>(sum);
    }
    for (std::size_t n = r.begin; n < r.end; ++n) force.x[n] = force.y[n] = force.z[n] = 0.0F;
}

// bound: B, sigma per model metre squared.
void FlexibleBody::move(BodyShape& shape, const FlexibleParts& parts, double bound, double step_s) noexcept {
    if (!(bound > 0.0 && std::isfinite(bound))) return;
    const std::size_t modes = parts.modes.count();
    std::array<double, kModesMax> a{}, way{}, force{};
    const auto dot = [modes](const auto& x, const auto& y) {
        double sum = 0.0;
        for (std::size_t k = 0; k < modes; ++k) sum += x[k] * y[k];
        return sum;
    };
    for (std::size_t k = 0; k < modes; ++k) {
        a[k] = static_cast<double>(shape.amplitude_m[k]);
        const double spring = kSoftness * parts.spring[k];
        force[k] = drive_[k] - spring * bound * a[k];
        // The spring implicitly: stable however stiff it is.
        way[k] = step_s * kRatePerS / bound * force[k] / (1.0 + step_s * kRatePerS * spring);
    }
    const double length = std::sqrt(dot(way, way)), most = kSpeedMost_m_s * step_s;
    for (std::size_t k = 0; k < modes && length > most; ++k) way[k] *= most / length;
    if (!strain_.shorten(parts, shape.amplitude_m, {way.data(), modes})) return;
    double square = 0.0;
    for (std::size_t k = 0; k < modes; ++k) square += (a[k] + way[k]) * (a[k] + way[k]);
    if (!(square <= kRmsdMost_m * kRmsdMost_m) ||
        !(dot(force, way) > 0.0 || strain_.strain() > StrainLimit::kMost))
        return;
    for (std::size_t k = 0; k < modes; ++k) shape.amplitude_m[k] = static_cast<float>(a[k] + way[k]);
    moved_ = std::sqrt(dot(way, way)) > kStillM_s * step_s;
}

void FlexibleBody::straighten(BodyShape& shape, double step_s) noexcept {
    const auto kept = static_cast<float>(std::exp(-kReturnPerS * step_s));
    for (float& a : shape.amplitude_m) a *= kept;
    if (shape.rmsd_m() < kStraightM) shape.amplitude_m.fill(0.0F);
    moved_ = true;
}

void FlexibleBody::step(const LevelBlend& blend, const Pose& T_model_body, const Budget& budget,
                        double step_s, bool flexible, bool free) noexcept {
    moved_ = false;
    if (!bent_ || id_ == 0) return;
    BodyShape* const shape = shape_of(id_);
    if (shape == nullptr || shape->id != id_) return;
    const FlexibleParts& parts = parts_[structure_];
    if (slice_ == 0) now_m_ = shape->amplitude_m;
    shift_nodes(parts);
    bend_points(parts, structure_);
    strain_.measure(parts, shift_, slice_of(slice_, parts.modes.nodes()).end);
    const LevelBlend::Plan plan = blend.plan(budget.fidelity);
    sum_forces(blend, plan.lower, 1.0 - plan.blend, T_model_body);
    if (plan.upper != plan.lower) sum_forces(blend, plan.upper, plan.blend, T_model_body);
    project_forces(parts);
    if (++slice_ == kSlices) end_pass(parts);
    if (passes_ < kPassesUntilKnown) return;
    if (!flexible) {
        straighten(*shape, good_step_s(step_s));
    } else if (free) {
        move(*shape, parts, blend.metrics.back().bends.by_shift, good_step_s(step_s));
    }
}

void FlexibleBody::forget_removed(const ModelBodies& bodies) noexcept {
    for (BodyShape& shape : shapes_) {
        const auto end = bodies.id.begin() + bodies.count;
        if (shape.id != 0 && std::find(bodies.id.begin(), end, shape.id) == end) shape = {};
    }
}

void FlexibleBody::take_shapes(const FlexibleBody& other) noexcept {
    shapes_ = other.shapes_;
    id_ = 0;  // the next hold() bends the points anew
}

}  // namespace tact
