// The isosurface; its number of vertices is the level "gui.mesh".
//
// Only the changes of the cut are uploaded. Frame model, metres.
// Thread   frame thread, context current.
#pragma once

#include <cstdint>
#include <vector>

#include "gui/render/contour_extract.hpp"
#include "gui/render/gl.hpp"
#include "gui/render/mesh_pace.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"

namespace tact {

class Surface {
public:
    explicit Surface(const ProgressiveMesh& mesh);  // mesh must outlive this

    // Moves towards `wanted` as far as `budget_s` allows for this and the next upload(); all the way if that takes no
    // longer than `at_once_s`. Call it every frame.
    void approach(std::uint32_t wanted, double budget_s, double at_once_s = 0.0) noexcept;
    // Returns bytes sent.
    std::size_t upload();
    void draw(const Eigen::Vector3f& colour);  // with a program in use
    [[nodiscard]] const MeshCut& cut() const { return cut_; }

private:
    MeshCut cut_;
    MeshPace pace_;
    bool drawn_ = false;  // the first upload sends everything and is not timed
    Duration moving_{};   // time of the last approach(), until its changes are uploaded
    std::vector<GLsizei> draw_count_;
    std::vector<const void*> draw_first_;
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
};

// A surface without levels of detail, uploaded as a whole.
class PlainSurface {
public:
    std::size_t fill(const PlainMesh& mesh);  // bytes sent
    void draw(const Eigen::Vector3f& colour);
    [[nodiscard]] std::uint32_t vertices() const { return vertex_count_; }
    [[nodiscard]] std::uint32_t triangles() const { return index_count_ / 3; }

private:
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
    std::uint32_t vertex_count_ = 0, index_count_ = 0;
};

}  // namespace tact
