#include "gui/drilling/drill_metrics.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kPathStepM = 3e-4;
constexpr double kHeldInS = 0.3;

}  // namespace

DrillMetrics::DrillMetrics(const BoneBricks& bricks, const BoneLabelsView& labels,
                           std::span<const DistanceField> fields, const SceneMeta& meta)
    : bricks_(bricks), labels_(labels), fields_(fields), meta_(meta) {
    metrics_.structure.resize(labels.structure.size() + 1);
    injured_s_.assign(metrics_.structure.size(), -1e9);
    metrics_.level_m3 = std::pow(meta.world_per_model * bricks.voxel_m, 3) / 255.0;
}

void DrillMetrics::tools(const DrillTopic& drill) {
    const DrillHand& burr = drill.hand[0];
    head_known_ = burr.kind == DrillKind::burr;
    if (!head_known_) return;
    head_ = head_balls(burr, meta_.world_per_model);
    head_at_m_ = Vec3(burr.pos_model_m[0], burr.pos_model_m[1], burr.pos_model_m[2]);
    // What went since the last call went by the burr that was in the hand then: one that is changed cuts nothing.
    if (!metrics_.burr.empty() && burr.removed_levels > burr_levels_)
        metrics_.burr[burr_].removed_levels += burr.removed_levels - burr_levels_;
    burr_levels_ = burr.removed_levels;
    burr_ = index_of(burr);
}

std::size_t DrillMetrics::index_of(const DrillHand& burr) {
    constexpr double kSameM = 1e-5;
    const BurrUse now{
        .shape = burr.shape, .grit = burr.grit, .diameter_m = 2.0 * static_cast<double>(burr.radius_m)};
    std::vector<BurrUse>& all = metrics_.burr;
    const auto found = std::find_if(all.begin(), all.end(), [&now](const BurrUse& b) {
        return b.shape == now.shape && b.grit == now.grit && std::abs(b.diameter_m - now.diameter_m) < kSameM;
    });
    if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
    if (all.size() == kBurrsMost) return all.size() - 1;
    all.push_back(now);
    return all.size() - 1;
}

void DrillMetrics::cycle(const TraceTopic& t) {
    const auto vec = [](const float(&v)[3]) {
        return Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
    };
    const Vec3 at_m = vec(t.pos_world_m);
    const double t_s = 1e-9 * static_cast<double>(t.taken_at_ns), force_n = vec(t.force_world_n).norm();
    if (!at_m.allFinite() || !std::isfinite(force_n) || at_m.cwiseAbs().maxCoeff() > 1e3) return;
    const double dt_s = t_s - cycle_s_;
    const bool goes_on = seen_ && dt_s >= 0.0 && dt_s < kDrillGapS;
    const double way_m = (at_m - path_at_m_).norm();
    seen_ = true;
    cycle_s_ = t_s;
    const bool turns = (t.status & kTraceBurrTurns) != 0, cuts = (t.status & kTraceCuts) != 0;
    strokes_.step(t_s, at_m, cuts);
    if (!goes_on || !turns) path_at_m_ = at_m;
    if (!goes_on) return;
    DrillMetricsRow& f = metrics_;
    f.seen_s += dt_s;
    const double held_in = (t.status & kTraceHeldIn) != 0 ? 1.0 : 0.0;
    held_in_share_ += std::min(dt_s / kHeldInS, 1.0) * (held_in - held_in_share_);
    if (!turns) return;
    f.drilling_s += dt_s;
    if (!f.burr.empty()) f.burr[burr_].drilling_s += dt_s;
    if (way_m > kPathStepM) {  // ignores encoder steps
        f.path_m += way_m;
        path_at_m_ = at_m;
    }
    f.force_n_most = std::max(f.force_n_most, force_n);
    if (force_n > kForceExcessN) f.excess_s += dt_s;
    if (cuts) {
        f.cutting_s += dt_s;
        if (!f.burr.empty()) f.burr[burr_].cutting_s += dt_s;
        f.force_cutting_n_s += dt_s * force_n;
    }
    if (!head_known_) return;
    const HeadBalls head = moved(head_, meta_.to_model(at_m) - head_at_m_);
    double least_m = 1e9;
    for (const DistanceField& field : fields_) {
        if (!labels_.critical(static_cast<std::uint8_t>(field.label))) continue;
        const double away_m = distance_m(field, head, meta_.world_per_model);
        StructureMetrics& s = f.structure[field.label];
        if (away_m < s.nearest_m) {
            s.nearest_m = away_m;
            s.nearest_at_model_m = meta_.to_model(at_m);
        }
        least_m = std::min(least_m, away_m);
        for (std::size_t i = 0; i < kDrillNearM.size(); ++i)
            if (away_m < kDrillNearM[i]) s.near_s[i] += dt_s;
    }
    for (std::size_t i = 0; i < kDrillNearM.size(); ++i)
        if (least_m < kDrillNearM[i]) f.near_s[i] += dt_s;
}

double DrillMetrics::nearest_critical_m(const Vec3& model_m) const {
    double least = 1e9;
    for (const DistanceField& field : fields_)
        if (labels_.critical(static_cast<std::uint8_t>(field.label)))
            least = std::min(least, field.distance_m(model_m));
    return least * meta_.world_per_model;
}

std::uint8_t DrillMetrics::brick(std::uint32_t brick, std::span<const std::uint8_t> before,
                                 std::span<const std::uint8_t> after, bool cut_now) {
    constexpr std::uint32_t kEdge = BoneBricks::kEdge;
    const std::size_t first = std::size_t{brick} * BoneBricks::kVoxels;
    if (brick >= bricks_.brick_count() || before.size() != BoneBricks::kVoxels ||
        after.size() != BoneBricks::kVoxels)
        return 0;
    const auto n = bricks_.bricks();
    const std::uint32_t bx = brick % n[0], by = brick / n[0] % n[1], bz = brick / n[0] / n[1];
    const Vec3 corner = Vec3(bx, by, bz) * double{kEdge};
    // Most bricks are far from every structure.
    const double half_m = 0.5 * std::sqrt(3.0) * kEdge * bricks_.voxel_m * meta_.world_per_model;
    const Vec3 middle = corner + Vec3::Constant(0.5 * (kEdge - 1.0));
    double error_m = 0.0;
    for (const DistanceField& field : fields_) error_m = std::max(error_m, field.error_m);
    const bool near =
        nearest_critical_m(bricks_.to_model(middle)) < kDrillNearM.back() + half_m + 2.0 * error_m;
    std::uint8_t injured = 0;
    for (std::uint32_t i = 0; i < BoneBricks::kVoxels; ++i) {
        if (after[i] == before[i]) continue;
        // Bone that comes back is subtracted: unsigned numbers wrap, and their sums are right.
        const auto levels = static_cast<std::uint64_t>(int{before[i]} - int{after[i]});
        const std::uint8_t label = labels_.label.empty() ? std::uint8_t{0} : labels_.label[first + i];
        metrics_.removed_levels += levels;
        StructureMetrics& s = metrics_.structure[label < metrics_.structure.size() ? label : 0];
        s.removed_levels += levels;
        if (near) {
            const std::uint32_t x = i % kEdge, y = i / kEdge % kEdge, z = i / kEdge / kEdge;
            const Vec3 at = corner + Vec3(x, y, z);
            const double away_m = nearest_critical_m(bricks_.to_model(at));
            for (std::size_t k = 0; k < kDrillNearM.size(); ++k)
                if (away_m < kDrillNearM[k]) metrics_.near_levels[k] += levels;
        }
        if (!cut_now || after[i] > before[i] || !labels_.critical(label)) continue;
        if (cycle_s_ - injured_s_[label] > kInjuryPauseS) {
            ++s.injuries;
            ++metrics_.injuries;
            injured = label;
        }
        injured_s_[label] = cycle_s_;
    }
    return injured;
}

DrillMetricsRow DrillMetrics::metrics() const {
    DrillMetricsRow all = metrics_;
    // A controller that adds bone to the scene's owes none.
    const auto not_below_zero = [](std::uint64_t& levels) {
        if (static_cast<std::int64_t>(levels) < 0) levels = 0;
    };
    not_below_zero(all.removed_levels);
    for (std::uint64_t& levels : all.near_levels) not_below_zero(levels);
    for (StructureMetrics& s : all.structure) not_below_zero(s.removed_levels);
    all.strokes = strokes_.metrics();
    return all;
}

}  // namespace tact
