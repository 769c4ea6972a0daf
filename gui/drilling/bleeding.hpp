// Where cut bone bleeds: vessels that were opened, walls of vessels, and red marrow a little.
//
// Opens    vessel: a voxel of a structure whose name is a vessel's; wall: bone right beside one; marrow: some of the
//          spongy voxels
// Stops    after its time, five times sooner where dust or paste lies on it: nothing comes out then
// Bounds   kWoundsMost at a time; a new one takes the place of an older one
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

    // label: as BoneLabelsView, or empty; it must outlive the object.
    Bleeding(const BoneBricks& bricks, const std::vector<BoneStructure>& structures,
             std::span<const std::uint8_t> label, std::uint64_t seed);

    // A voxel of this density is bone no more.
    void cut(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint8_t density) noexcept;
    // At most so many drops in this step.
    void step(double dt_s, std::size_t drops_most, Particles& particles) noexcept;
    [[nodiscard]] std::size_t wounds() const noexcept { return wounds_.size(); }
    // Drops that came out so far.
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
    std::size_t oldest_ = 0;  // where there are as many as there may be
    SeededRandom random_;
    std::uint64_t drops_ = 0;
};

}  // namespace tact
