// Triangles with normals and colours in graphics memory.
#pragma once

#include "gui/render/gl.hpp"
#include "gui/render/tube.hpp"

namespace tact {

class TriangleBuffers {
public:
    void fill(const TubeMesh& mesh, GLenum usage);
    void draw();  // with a program of triangles in use
    [[nodiscard]] GLsizei indices() const { return count_; }
    void clear() { count_ = 0; }  // must be filled again

private:
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
    GLsizei count_ = 0;
};

}  // namespace tact
