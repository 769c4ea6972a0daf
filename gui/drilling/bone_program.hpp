// Ray casting of the bone, and drawing of its image on the screen.
//
// Ray       skips empty cells at once (BoneField), steps by `step_voxels` elsewhere, and halves the step that
//           entered the surface. Colour: of the structure, else by the density behind the surface. Light: as for
//           everything else, times the open fraction of the sky above the surface, times a soft shadow of the lamp.
//           Wet bone is darker and glitters; blood stains it.
// Frames    voxels (origin at the centre of voxel 0) inside the shader; eye space in ångström as in all programs
// Thread    frame thread, context current
#pragma once

#include "gui/drilling/bone_textures.hpp"
#include "gui/render/gl.hpp"
#include "gui/render/shading.hpp"

namespace tact {

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
