// The surface as a controller refines it around the tool: full detail there, coarse elsewhere, edge length as colour.
//
// Cut       ipc/scene/mesh/refinement.hpp, the code of tact-rt, with the same filter at the same place: once both
//           have settled, the cuts are equal. tact-rt looks ahead along the tool's motion; this does not.
// Colour    viridis by the logarithm of the mean edge length at a vertex, from `coarsest_m` (violet) to `finest_m`
//           (yellow), powers of two that enclose nine tenths of the mesh's lengths.
// Thread    one calls step() and owns the result. It allocates.
#pragma once

#include <optional>

#include "gui/render/scene_content.hpp"
#include "gui/render/tube.hpp"
#include "ipc/scene/mesh/refinement.hpp"

namespace tact {

struct DetailRequest {
    Vec3 probe_m = Vec3::Zero();  // model
    double radius_m = 0.0;        // of the zone of full detail
    FilterForm form;

    [[nodiscard]] bool operator==(const DetailRequest&) const = default;
};

struct DetailMesh {
    TubeMesh mesh;  // scene frame
    double finest_m = 0.0, coarsest_m = 0.0;
    std::uint32_t vertices = 0, triangles = 0;
    double deviation_m = 0.0;  // from the full mesh, at most
    bool settled = false;      // false: further steps will change it
};

class DetailCut {
public:
    // The content needs a surface and a forest, and must outlive this object.
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
