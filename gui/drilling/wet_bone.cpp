#include "gui/drilling/wet_bone.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr float kWetAtOnce = 0.55F, kWetPerDrop = 0.15F;
constexpr float kStainAtOnce = 0.35F, kStainPerDrop = 0.1F, kWashPerDrop = 0.04F;
constexpr float kDry = 1.0F / 32.0F;
constexpr int kStep = 16;

std::uint8_t shown_of(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F) / kStep * kStep);
}

}  // namespace

WetBone::WetBone(const BoneBricks& bricks) : bricks_(bricks), brick_changed_(bricks.brick_count()) {
    const auto n = bricks.bricks();
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = n[axis] * (BoneBricks::kEdge / kCell);
    shown_.resize(std::size_t{size_[0]} * size_[1] * size_[2]);
    place_.resize(shown_.size());
}

void WetBone::step(double dt_s, std::span<const Particle> particles, const ParticleCells& cells) {
    for (const std::uint32_t brick : changed_) brick_changed_[brick] = 0;
    changed_.clear();
    since_look_s_ += std::max(dt_s, 0.0);
    if (since_look_s_ < 1.0 / kLooksPerS) return;
    const auto dries = static_cast<float>(std::exp(-since_look_s_ / kDriesS)),
               fades = static_cast<float>(std::exp(-since_look_s_ / kFadesS));
    since_look_s_ = 0.0;
    look(particles, cells);
    for (std::size_t i = 0; i < wet_.size();) {
        Wet& w = wet_[i];
        const Touch touch = touch_[i];
        w.water *= dries;
        w.stain *= fades;
        if (touch.water + touch.blood > 0)
            w.water = std::min(
                std::max(w.water, kWetAtOnce) + kWetPerDrop * static_cast<float>(touch.water + touch.blood),
                1.0F);
        if (touch.blood > 0)
            w.stain = std::min(
                std::max(w.stain, kStainAtOnce) + kStainPerDrop * static_cast<float>(touch.blood), 1.0F);
        w.stain = std::max(w.stain - kWashPerDrop * static_cast<float>(touch.water), 0.0F);
        const bool dry = w.water < kDry && w.stain < kDry;
        if (dry) w.water = w.stain = 0.0F;
        show(w);
        if (!dry) {
            ++i;
            continue;
        }
        place_[w.cell] = 0;
        w = wet_.back();
        touch_[i] = touch_.back();
        if (i + 1 < wet_.size()) place_[w.cell] = static_cast<std::uint32_t>(i + 1);
        wet_.pop_back();
        touch_.pop_back();
    }
}

void WetBone::look(std::span<const Particle> particles, const ParticleCells& cells) {
    touch_.assign(wet_.size(), {});
    const auto margin = static_cast<float>(cells.of_voxel(0, 0, 0)[0]);
    for (const Particle& p : particles) {
        if (p.matter == Matter::dust) continue;
        std::array<std::uint32_t, 3> at{};
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float voxel = p.at[axis] - margin;
            inside = inside && voxel >= 0.0F && voxel < static_cast<float>(bricks_.size[axis]);
            at[axis] = inside ? static_cast<std::uint32_t>(voxel) / kCell : 0;
        }
        if (!inside) continue;
        const std::uint32_t cell = (at[2] * size_[1] + at[1]) * size_[0] + at[0];
        if (place_[cell] == 0) {
            wet_.push_back({cell, 0.0F, 0.0F});
            touch_.emplace_back();
            place_[cell] = static_cast<std::uint32_t>(wet_.size());
        }
        Touch& touch = touch_[place_[cell] - 1];
        std::uint16_t& count = p.matter == Matter::blood ? touch.blood : touch.water;
        if (count < 1000) ++count;
    }
}

void WetBone::show(const Wet& wet) {
    const Texel now{shown_of(wet.water), shown_of(wet.stain)};
    Texel& before = shown_[wet.cell];
    if (now == before) return;
    before = now;
    constexpr std::uint32_t kCells = BoneBricks::kEdge / kCell;
    const auto n = bricks_.bricks();
    const std::uint32_t x = wet.cell % size_[0], y = wet.cell / size_[0] % size_[1],
                        z = wet.cell / size_[0] / size_[1];
    const std::uint32_t brick = (z / kCells * n[1] + y / kCells) * n[0] + x / kCells;
    if (brick_changed_[brick] != 0) return;
    brick_changed_[brick] = 1;
    changed_.push_back(brick);
}

}  // namespace tact
