// Spheres and sticks as impostors: one quad per shape, on which the fragment shader intersects the eye ray with the
// exact shape. Round at any size, with per-pixel depth and lighting.
//
// Quad     the bounds of the shape in perspective, at its nearest point; all corners have one depth, so that
//          interpolation is exact. A shape that reaches the eye is not drawn.
// Depth    of the intersection: impostors intersect each other and meshes correctly.
// Thread   frame thread, context current.
#pragma once

#include <span>
#include <vector>

#include "gui/docking/atom_shapes.hpp"
#include "gui/render/elements.hpp"
#include "gui/render/looks.hpp"
#include "gui/render/shading.hpp"

namespace tact {

// Parameters of a draw besides the shapes.
struct ImpostorView {
    Eigen::Matrix4f eye_from_local, projection;  // local: ångström
    const Haze& haze;
    Colouring colouring = Colouring::chain;
    Rgb8 body{255, 255, 255};  // for colouring by body
    float grow = 1.0F;         // factor on the radii of spheres
};

// The shapes of one structure in graphics memory, shared by all its copies.
class ImpostorShapes {
public:
    void fill(std::span<const Sphere> spheres);
    void fill(std::span<const Stick> sticks);
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool filled() const { return filled_; }
    void clear() { filled_ = false; }  // must be filled again
    void draw() { draw(count_); }
    void draw(std::size_t first);  // as many of them, from the first on

private:
    template <class Shape>
    void send(std::span<const Shape> shapes);
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
    std::size_t count_ = 0;
    bool filled_ = false;
};

class ImpostorPrograms {
public:
    ImpostorPrograms();
    void use_spheres(const ImpostorView& view);
    void use_sticks(const ImpostorView& view);

private:
    struct Program {
        Program(const char* what, const char* vertex, const char* fragment);
        void use(const ImpostorView& view) const;
        GlProgram program;
        ViewUniforms view;
        GLint pick, body, grow;
    };
    Program spheres_, sticks_;
};

}  // namespace tact
