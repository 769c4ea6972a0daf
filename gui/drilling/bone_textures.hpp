// The bone in graphics memory: opacities, empty cells, labels with their colours, and what is wet.
//
// Thread    frame thread, context current
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "gui/drilling/bone_field.hpp"
#include "gui/drilling/wet_bone.hpp"
#include "gui/render/gl.hpp"

namespace tact {

// The volume in graphics memory, created and filled over many frames: one texture at a time, because memory for a
// large one takes a good part of a frame; then slab by slab from the front (largest z). Voxels not yet sent are
// invisible.
class BoneTextures {
public:
    BoneTextures(const BoneField& field, std::span<const BoneStructure> structures);
    // Continues for this long, and for at least one texture or slab. Throws StartupError if the graphics driver has
    // not enough memory.
    void fill(const BoneField& field, double seconds);
    [[nodiscard]] bool made() const { return unmade_ == 0; }  // ready to draw with
    [[nodiscard]] bool full() const { return made() && unsent_ == 0; }
    [[nodiscard]] float filled(const BoneField& field) const;  // fraction
    // For parts already sent:
    void send(const BoneField& field, std::uint32_t brick);  // its voxels and cells
    void send_cells(const BoneField& field);                 // all of them
    void send_wet(const WetBone& wet);                       // the cells that changed, at first all
    void bind();
    [[nodiscard]] Eigen::Array3f wet_size_voxels() const {
        return Eigen::Array3<std::uint32_t>(WetBone::kCell * wet_size_[0], WetBone::kCell * wet_size_[1],
                                            WetBone::kCell * wet_size_[2])
            .cast<float>();
    }
    [[nodiscard]] const std::array<std::uint32_t, 3>& label_size() const { return label_size_; }

private:
    void make_next(const BoneField& field);
    void send_cells(const BoneField& field, std::uint32_t first,
                    std::uint32_t count);  // of these layers of bricks

    GlTexture solid_, cells_, label_, wet_, palette_;
    std::array<std::uint32_t, 3> label_size_{};       // 1 x 1 x 1 without labels
    std::array<std::uint32_t, 3> wet_size_{1, 1, 1};  // 1 x 1 x 1: dry
    int unmade_ = 3;                                  // textures
    std::uint32_t unsent_;                            // layers of bricks, from z = 0
};

}  // namespace tact
