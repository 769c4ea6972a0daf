// Bleeding of cut bone: opened vessels, walls of vessels, and a little from red marrow.
//
// Opens    vessel: a voxel of a structure named as a vessel; wall: bone next to one; marrow: a few of the spongy
//          voxels
// Stops    after its time, five times sooner under dust or paste, which also block the flow
// Bounds   kWoundsMost at a time; a new one replaces the oldest
// Thread   one; no allocation after construction
#pragma once

#include <array>
#include <span>
#include <vector>

#include "gui/drilling/particles.hpp"
#include "ipc/scene/bone/bone_labels.hpp"

namespace tact {

class Bleeding {
public:
    static constexpr std::size_t kWoundsMost = 400;

    // label: as in BoneLabelsView, or empty; it must outlive this object.
    Bleeding(const BoneBricks& bricks, const std::vector<BoneStructure>& structures,
             std::span<const std::uint8_t> label, std::uint64_t seed);

    // A voxel of this density has been removed.
    void cut(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint8_t density) noexcept;
    // Wounds where bone came back are gone.
    void close(const ParticleCells& cells) noexcept;
    // At most this many drops in this step.
    void step(double dt_s, std::size_t drops_most, Particles& particles) noexcept;
    [[nodiscard]] std::size_t wounds() const noexcept { return wounds_.size(); }
    // Total number of drops so far.
    [[nodiscard]] std::uint64_t drops() const noexcept { return drops_; }

private:
    struct Wound {
        Vec3 at_m;
        double drops_per_s, left_s, owed;
    };
    void open(std::uint32_t x, std::uint32_t y, std::uint32_t z, double drops_per_s, double lasts_s) noexcept;
    [[nodiscard]] bool vessel(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept;

    BoneBricks bricks_;
    std::span<const std::uint8_t> label_;
    std::array<bool, 256> is_vessel_{};  // by label
    std::vector<Wound> wounds_;
    std::size_t oldest_ = 0;  // once kWoundsMost is reached
    SeededRandom random_;
    std::uint64_t drops_ = 0;
};

}  // namespace tact
