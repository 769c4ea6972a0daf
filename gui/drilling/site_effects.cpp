#include "gui/drilling/site_effects.hpp"

#include <algorithm>
#include <cmath>

#include "gui/drilling/burr_sight.hpp"

namespace tact {
namespace {

constexpr double kLongestFrame_s = 0.1;
constexpr double kStep_s = 0.012;  // target; the rules rest and topple particles once per step
constexpr int kStepsMost = 4;
// Dust leaves the burr along its rotation, and out of the hole.
constexpr double kAlong_m_s = 0.3, kOut_m_s = 0.2;
// Water per second, as a fraction of the maximum number of particles: dust and blood need space too.
constexpr double kWaterShare_per_s = 0.15;
constexpr double kBloodShare_per_s = 0.04;
constexpr double kJet_m_s = 0.5;
constexpr double kNozzle = 3.0;        // radii of the head, up the shaft
constexpr double kStirred = 0.9;       // of the head's radius: the rules act at its rim
constexpr double kSuctionReach = 1.6;  // radii of the tube
constexpr double kLookEvery_s = 0.05;
constexpr double kSeenFrom = 0.5;  // fraction of the head

Vec3 vec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
Quat quat(const double (&q)[4]) { return Quat(q[3], q[0], q[1], q[2]); }

const DrillHand* find(const DrillTopic* drill, DrillKind kind) {
    if (drill == nullptr) return nullptr;
    const auto* const end = drill->hand + kDrillHands;
    const auto* const found =
        std::find_if(drill->hand, end, [kind](const DrillHand& h) { return h.kind == kind; });
    return found == end ? nullptr : found;
}

ParticleSettings settings_of(double world_per_model) {
    ParticleSettings s;
    s.most = SiteEffects::kMost;
    s.gravity_m_s2 = Vec3(0.0, 0.0, -9.81 / world_per_model);
    s.fastest_m_s = 1.0 / world_per_model;
    return s;
}

}  // namespace

SiteEffects::SiteEffects(const BoneVolumeView& bone, const BoneLabelsView& labels, double world_per_model)
    : bricks_(bone.bricks),
      world_per_model_(world_per_model),
      particles_(bone.bricks, bone.density, settings_of(world_per_model)),
      bleeding_(bone.bricks, labels.structure, labels.label, 3),
      wet_(bone.bricks) {
    metrics_.most = kMost;
}

void SiteEffects::step(const Frame& frame) noexcept {
    const double dt_s = std::clamp(frame.dt_s, 0.0, kLongestFrame_s);
    const double level = frame.level >= 0.0F ? std::min(static_cast<double>(frame.level), 1.0) : 0.0;
    const DrillHand* const burr = find(frame.drill, DrillKind::burr);
    const DrillHand* const suction_tube = find(frame.drill, DrillKind::suction_tube);
    kept_ = static_cast<std::uint32_t>(std::lround(level * kMost));
    particles_.keep_at_most(kept_);
    take_changes(frame, burr);
    if (burr != nullptr) spray(dt_s, *frame.drill, *burr);
    bleeding_.step(dt_s, static_cast<std::size_t>(std::ceil(kBloodShare_per_s * kept_ * dt_s)), particles_);
    scatter();  // after the particles of drilling, which take precedence

    Vec3 looked_at_m = bricks_.to_model(0.5 * Vec3(bricks_.size[0], bricks_.size[1], bricks_.size[2]));
    Stir stir;
    if (burr != nullptr) {
        looked_at_m = vec(burr->pos_model_m);
        if (burr->burr_rad_s > 0.0F)
            stir = {looked_at_m, kStirred * static_cast<double>(burr->radius_m) / world_per_model_,
                    quat(burr->quat_model_tool_xyzw) * Vec3(0.0, 0.0, static_cast<double>(burr->burr_rad_s))};
    }
    Suction suction;
    if (suction_tube != nullptr && suction_tube->suction > 0.0F)
        suction = {vec(suction_tube->pos_model_m),
                   kSuctionReach * static_cast<double>(suction_tube->radius_m) *
                       std::sqrt(static_cast<double>(suction_tube->suction)) / world_per_model_};
    const int steps = std::clamp(static_cast<int>(std::lround(dt_s / kStep_s)), 1, kStepsMost);
    metrics_.moves = 0;
    metrics_.cost_s = 0.0;
    for (int i = 0; i < steps; ++i) {
        const ParticleStep done =
            particles_.step(dt_s / steps, level * kBudgetMost_s / steps, looked_at_m, suction, stir);
        metrics_.moves += done.moved;
        metrics_.cost_s += done.cost_s;
        metrics_.suction_blocked = done.suction_blocked;
    }
    metrics_.alive = static_cast<std::uint32_t>(particles_.all().size());
    metrics_.shown = static_cast<std::uint32_t>(particles_.shown().size());
    wet_.step(dt_s, particles_.shown(), particles_.cells());
    look(dt_s, burr, frame.eye_model_m);
}

void SiteEffects::scatter() noexcept {
    const auto there = static_cast<std::uint32_t>(particles_.all().size());
    const std::uint32_t wanted = std::min(scattered_, kept_);
    if (there >= wanted) return;
    const std::uint32_t missing = wanted - there;
    const Vec3 size(bricks_.size[0], bricks_.size[1], bricks_.size[2]);
    for (std::uint32_t i = 0, tries = 0; i < missing && tries < 4 * missing; ++tries) {
        const Vec3 at =
            size.cwiseProduct(Vec3(random_.uniform(), random_.uniform(), 0.3 + 0.7 * random_.uniform()));
        i += particles_.emit(static_cast<Matter>(random_.below(4)), bricks_.to_model(at), Vec3::Zero()) ? 1
                                                                                                        : 0;
    }
}

void SiteEffects::take_changes(const Frame& frame, const DrillHand* burr) noexcept {
    constexpr std::uint32_t kEdge = BoneBricks::kEdge;
    const auto n = bricks_.bricks();
    const Vec3 out =
        burr != nullptr ? Vec3(quat(burr->quat_model_tool_xyzw) * Vec3(0.0, 0.0, 1.0)) : Vec3(0.0, 0.0, 1.0);
    if (std::any_of(frame.changes.begin(), frame.changes.end(),
                    [](const BrickChange& change) { return change.grown(); })) {
        particles_.bury();
        bleeding_.close(particles_.cells());
    }
    for (const BrickChange& change : frame.changes) {
        if (!change.cut_now) continue;
        const std::uint32_t bx = change.brick % n[0] * kEdge, by = change.brick / n[0] % n[1] * kEdge,
                            bz = change.brick / n[0] / n[1] * kEdge;
        for (std::uint32_t i = 0; i < BoneBricks::kVoxels; ++i) {
            const std::uint8_t before = change.before[i], after = change.after[i];
            if (after >= before) continue;
            const std::uint32_t x = bx + i % kEdge, y = by + i / kEdge % kEdge, z = bz + i / (kEdge * kEdge);
            Vec3 velocity = kOut_m_s * out;
            if (burr != nullptr) {
                const Vec3 along = out.cross(bricks_.to_model(Vec3(x, y, z)) - vec(burr->pos_model_m));
                if (along.squaredNorm() > 0.0) velocity += kAlong_m_s * along.normalized();
            }
            particles_.drilled(x, y, z, static_cast<std::uint32_t>(before - after),
                               velocity / world_per_model_);
            if (before >= ParticleCells::kBoneFrom && after < ParticleCells::kBoneFrom)
                bleeding_.cut(x, y, z, before);
        }
    }
}

// A jet along the shaft onto the head; a drop is a voxel.
void SiteEffects::spray(double dt_s, const DrillTopic& drill, const DrillHand& burr) noexcept {
    const double flow_m3_s = static_cast<double>(burr.irrigation * drill.irrigation_m3_s_most);
    const double drop_m3 = std::pow(bricks_.voxel_m * world_per_model_, 3);
    water_owed_ += std::min(flow_m3_s / drop_m3, kWaterShare_per_s * kept_) * dt_s;
    const Quat q = quat(burr.quat_model_tool_xyzw);
    const double radius_m = static_cast<double>(burr.radius_m) / world_per_model_;
    const Vec3 head = vec(burr.pos_model_m), shaft = q * Vec3(0.0, 0.0, 1.0);
    const Vec3 nozzle = head + radius_m * (kNozzle * shaft + q * Vec3(0.0, 0.9, 0.0));
    const int drops = static_cast<int>(water_owed_);
    water_owed_ -= drops;
    for (int i = 0; i < drops; ++i) {
        const Vec3 from = nozzle + 0.35 * radius_m * random_.direction();
        const Vec3 to = head + 0.6 * radius_m * random_.direction();
        static_cast<void>(
            particles_.emit(Matter::water, from, kJet_m_s / world_per_model_ * (to - from).normalized()));
    }
}

void SiteEffects::look(double dt_s, const DrillHand* burr, const Vec3& eye_model_m) noexcept {
    if (burr == nullptr || !(burr->burr_rad_s > 0.0F) || !(burr->depth > 0.0F)) return;
    looked_s_ += dt_s;
    if (looked_s_ >= kLookEvery_s) {
        looked_s_ = 0.0;
        seen_ = share_seen(particles_, vec(burr->pos_model_m),
                           static_cast<double>(burr->radius_m) / world_per_model_, eye_model_m) >= kSeenFrom;
    }
    metrics_.drilling_s += dt_s;
    if (seen_) metrics_.seen_s += dt_s;
}

}  // namespace tact
