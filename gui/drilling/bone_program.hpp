// Ray casting of the bone, and drawing of its image on the screen.
//
// Ray       skips empty cells at once (BoneField), steps by `step_voxels` elsewhere, and halves the step that
//           entered the surface. Colour: of the structure, else by the density behind the surface. Light: as for
//           everything else, times the open fraction of the sky above the surface, times a soft shadow of the lamp.
//           Wet bone is darker and glitters; blood stains it.
// Frames    voxels (origin at the centre of voxel 0) inside the shader; eye space in ångström as in all programs
// Thread    frame thread, context current
#pragma once

#include "gui/drilling/bone_field.hpp"
#include "gui/drilling/wet_bone.hpp"
#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"

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

class BoneProgram {
public:
    BoneProgram();
    // The next draw supplies attribute 0: corners in clip space, two numbers each.
    void use(BoneTextures& textures, const BoneField& field, const Eigen::Matrix4f& eye_from_voxels,
             const Eigen::Matrix4f& projection, const Haze& haze, float step_voxels, bool coaxial_light);

private:
    GlProgram program_;
    ViewUniforms view_;
    GLint size_, label_size_, cells_, origin_, from_eye_, tan_, step_, lamp_, wet_size_, coaxial_, slopes_;
};

// Draws part of an image with its depths over the existing content where it is nearer.
class BoneOnScreen {
public:
    BoneOnScreen();
    // Clip space as above, which shows the part [0, `share`] of the image.
    void use(GLuint colour, GLuint depth, float share_x, float share_y, bool smooth);

private:
    GlProgram program_;
    GLint share_;
};

}  // namespace tact
