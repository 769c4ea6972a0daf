// The rays through the bone, and putting what they saw on the screen.
//
// Ray       leaves empty cells at once (BoneField), steps by `step_voxels` elsewhere, and halves the step at which it
//           entered the surface. Colour: of the structure, else by how dense the bone is behind its surface. Light: as
//           everything else, times how much of the sky above the surface is open, times a soft shadow of the lamp.
// Frames    voxels (centre of voxel 0 at the origin) inside the shader; eye space in ångström as all programs
// Thread    frame thread, context current
#pragma once

#include "gui/drilling/bone_field.hpp"
#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"

namespace tact {

// The volume in graphics memory. It is made and filled over many pictures: a texture at a time, as memory for a large one
// takes a good part of a frame; then from its front, the largest z, slab by slab. What was not sent yet is not seen.
class BoneTextures {
public:
    BoneTextures(const BoneField& field, std::span<const BoneStructure> structures);
    // Goes on for so long, and for one texture or slab at least. Throws StartupError where the graphics driver has no room
    // for it.
    void fill(const BoneField& field, double seconds);
    [[nodiscard]] bool made() const { return unmade_ == 0; }  // there is something to draw with
    [[nodiscard]] bool full() const { return made() && unsent_ == 0; }
    [[nodiscard]] float filled(const BoneField& field) const;  // share
    // Of what was sent already:
    void send(const BoneField& field, std::uint32_t brick);  // its voxels and cells
    void send_cells(const BoneField& field);                 // all of them
    void bind();
    [[nodiscard]] const std::array<std::uint32_t, 3>& label_size() const { return label_size_; }

private:
    void make_next(const BoneField& field);
    void send_cells(const BoneField& field, std::uint32_t first,
                    std::uint32_t count);  // of these layers of bricks

    GlTexture solid_, cells_, label_, palette_;
    std::array<std::uint32_t, 3> label_size_{};  // 1 x 1 x 1 where nothing is labelled
    int unmade_ = 3;                             // textures
    std::uint32_t unsent_;                       // layers of bricks, from z = 0 on
};

class BoneProgram {
public:
    BoneProgram();
    // Corners in clip space, two numbers each, are attribute 0 of what is drawn next.
    void use(BoneTextures& textures, const BoneField& field, const Eigen::Matrix4f& eye_from_voxels,
             const Eigen::Matrix4f& projection, const Haze& haze, float step_voxels);

private:
    GlProgram program_;
    ViewUniforms view_;
    GLint size_, label_size_, cells_, origin_, from_eye_, tan_, step_, lamp_;
};

// Draws a part of an image with its depths over what is there, where they are nearer.
class BoneOnScreen {
public:
    BoneOnScreen();
    // Clip space as above; what is shown there is image(clip -> [0, `share`]).
    void use(GLuint colour, GLuint depth, float share_x, float share_y, bool smooth);

private:
    GlProgram program_;
    GLint share_;
};

}  // namespace tact
