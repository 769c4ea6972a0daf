// The surface as a controller keeps it around the tool: full detail there, coarse elsewhere, the length of edges as colour.
//
// Cut       ipc/scene/mesh/refinement.hpp, the code that tact-rt runs, with the same form of filter about the same place:
//           where both have settled the cut is the same. tact-rt looks ahead along the tool's way, this does not.
// Colour    viridis by the logarithm of the mean length of the edges at a vertex, from `coarsest_m` (violet) to
//           `finest_m` (yellow), which are taken from the mesh itself: powers of two that hold nine tenths.
// Thread    one calls step(); what it returns is nobody else's. It allocates.
#pragma once

#include <optional>

#include "gui/render/scene_content.hpp"
#include "gui/render/tube.hpp"
#include "ipc/scene/mesh/refinement.hpp"

namespace tact {

struct DetailRequest {
    Vec3 probe_m = Vec3::Zero();  // model
    double radius_m = 0.0;        // of full detail
    FilterForm form;

    [[nodiscard]] bool operator==(const DetailRequest&) const = default;
};

struct DetailMesh {
    TubeMesh mesh;  // scene frame
    double finest_m = 0.0, coarsest_m = 0.0;
    std::uint32_t vertices = 0, triangles = 0;
    double deviation_m = 0.0;  // from the full mesh, at the most
    bool settled = false;      // false: more steps will change it
};

class DetailCut {
public:
    // The content needs a surface and a forest, and outlives this.
    explicit DetailCut(const SceneContent& content);
    DetailMesh step(const DetailRequest& request);

private:
    [[nodiscard]] TubeMesh build(double& finest_m, double& coarsest_m);

    const SceneContent& content_;
    Refinement refinement_;
    FilterForm form_;
    double radius_m_ = -1.0;
    std::vector<std::uint32_t> index_of_;  // vertex of the mesh, by place
    std::vector<float> length_m_, edges_;  // sums, by vertex
};

}  // namespace tact
