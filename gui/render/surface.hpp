// The isosurface, with the number of its vertices as the knob "gui.mesh".
//
// Only what the cut changed is sent to the graphics card. Frame model, metres.
// Thread   frame thread, context current.
#pragma once

#include <cstdint>

#include "gui/render/gl.hpp"
#include "ipc/assets/mesh_cut.hpp"

namespace tact {

class Surface {
public:
    explicit Surface(const ProgressiveMesh& mesh);  // mesh must outlive this

    void set_vertices(std::uint32_t wanted) noexcept { cut_.set_vertices(wanted); }
    // Bytes sent.
    std::size_t upload();
    void draw();  // with a program in use
    [[nodiscard]] const MeshCut& cut() const { return cut_; }

private:
    MeshCut cut_;
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
};

}  // namespace tact
