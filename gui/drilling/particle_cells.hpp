// The cells of particles: the voxels of the bone volume and a margin around them. One particle per cell.
//
// Unit     cells: voxels, counted from the corner of the margin; a point p lies in cell floor(p)
// Memory   two bits per cell
// Bone     read in its current state: another process removes it meanwhile
// Thread   one; no allocation after construction
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/prefetch.hpp"
#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

using Cell = std::array<int, 3>;

enum class CellState : std::uint8_t { free, grain, liquid, paste };

class ParticleCells {
public:
    // Lowest density of bone: includes soft structures, which have 40 (prep/synthetic). Cells of the margin are never
    // bone.
    static constexpr std::uint8_t kBoneFrom = 32;

    // density: in the order of `bricks`, or empty without bone; it must outlive this object.
    ParticleCells(const BoneBricks& bricks, std::span<const std::uint8_t> density, std::uint32_t margin);

    [[nodiscard]] const Cell& size() const noexcept { return size_; }
    [[nodiscard]] double cell_m() const noexcept { return bricks_.voxel_m; }
    [[nodiscard]] bool inside(const Cell& c) const noexcept {
        return static_cast<unsigned>(c[0]) < static_cast<unsigned>(size_[0]) &&
               static_cast<unsigned>(c[1]) < static_cast<unsigned>(size_[1]) &&
               static_cast<unsigned>(c[2]) < static_cast<unsigned>(size_[2]);
    }
    // The cell must be inside.
    [[nodiscard]] CellState state(const Cell& c) const noexcept {
        const std::size_t i = index(c);
        return static_cast<CellState>(state_[i / 4] >> (2 * (i % 4)) & 3U);
    }
    void set(const Cell& c, CellState state) noexcept {
        const std::size_t i = index(c);
        const unsigned shift = 2 * (i % 4);
        state_[i / 4] = static_cast<std::uint8_t>((state_[i / 4] & ~(3U << shift)) |
                                                  static_cast<unsigned>(state) << shift);
    }
    [[nodiscard]] bool bone(const Cell& c) const noexcept {
        const auto x = static_cast<std::uint32_t>(c[0] - margin_),
                   y = static_cast<std::uint32_t>(c[1] - margin_),
                   z = static_cast<std::uint32_t>(c[2] - margin_);
        if (density_.empty() || x >= bricks_.size[0] || y >= bricks_.size[1] || z >= bricks_.size[2])
            return false;
        return __atomic_load_n(&density_[bricks_.voxel(x, y, z)], __ATOMIC_RELAXED) >= kBoneFrom;
    }
    // Neither bone nor a particle; the cell must be inside.
    [[nodiscard]] bool free(const Cell& c) const noexcept { return state(c) == CellState::free && !bone(c); }

    // Prefetches the data of a cell, which must be inside.
    void fetch(const Cell& c) const noexcept {
        prefetch(&state_[index(c) / 4]);
        const auto x = static_cast<std::uint32_t>(c[0] - margin_),
                   y = static_cast<std::uint32_t>(c[1] - margin_),
                   z = static_cast<std::uint32_t>(c[2] - margin_);
        if (density_.empty() || x >= bricks_.size[0] || y >= bricks_.size[1] || z >= bricks_.size[2]) return;
        prefetch(&density_[bricks_.voxel(x, y, z)]);
    }

    [[nodiscard]] Vec3 to_cells(const Vec3& model_m) const noexcept {
        return bricks_.to_voxels(model_m).array() + (0.5 + margin_);
    }
    [[nodiscard]] Vec3 to_model(const Vec3& cells) const noexcept {
        return bricks_.to_model(cells.array() - (0.5 + margin_));
    }
    [[nodiscard]] Cell of_voxel(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
        return {static_cast<int>(x) + margin_, static_cast<int>(y) + margin_, static_cast<int>(z) + margin_};
    }

private:
    [[nodiscard]] std::size_t index(const Cell& c) const noexcept {
        return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(size_[1]) +
                static_cast<std::size_t>(c[1])) *
                   static_cast<std::size_t>(size_[0]) +
               static_cast<std::size_t>(c[0]);
    }

    BoneBricks bricks_;
    std::span<const std::uint8_t> density_;
    int margin_;
    Cell size_{};
    std::vector<std::uint8_t> state_;
};

}  // namespace tact
