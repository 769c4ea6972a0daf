#include "gui/surface/detail_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "gui/render/viridis.hpp"
#include "gui/surface/surface_content.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kNoVertex = UINT32_MAX;
constexpr std::uint32_t kVerticesMost = 400'000;

RefinementSettings settings_of(const SceneContent& content) {
    RefinementSettings s;
    s.look_ahead_s = 0.0;
    s.splits_max = s.merges_max = 20'000;
    // The coarsest mesh must fit, whatever its size.
    s.nodes_max = std::max(kVerticesMost, content.of<SurfaceContent>()->detail->forest.roots());
    return s;
}

// Quantiles of the lengths at which the scale ends, rounded outwards to a power of two.
constexpr double kFinestShare = 0.05, kCoarsestShare = 0.95;

}  // namespace

DetailCut::DetailCut(const SceneContent& content)
    : content_(content), refinement_(content.of<SurfaceContent>()->detail->forest, settings_of(content)) {
    const VertexForest& forest = content.of<SurfaceContent>()->detail->forest;
    index_of_.assign(std::size_t{forest.leaves()} + forest.nodes(), kNoVertex);
}

DetailMesh DetailCut::step(const DetailRequest& request) {
    if (request.radius_m != radius_m_ || request.form != form_) {
        radius_m_ = request.radius_m;
        form_ = request.form;
        refinement_.set_filter(form_.filter(static_cast<float>(radius_m_)));
    }
    const RefineStep done = refinement_.step(request.probe_m, Vec3::Zero());
    DetailMesh out;
    out.settled = done.settled || done.no_room;
    out.vertices = done.vertices;
    out.triangles = done.triangles;
    out.deviation_m = static_cast<double>(refinement_.deviation_m());
    out.mesh = build(out.finest_m, out.coarsest_m);
    return out;
}

TubeMesh DetailCut::build(double& finest_m, double& coarsest_m) {
    TubeMesh mesh;
    length_m_.clear();
    edges_.clear();
    std::vector<std::uint32_t> places;  // to be reset
    const auto vertex = [&](std::uint32_t place) {
        std::uint32_t& index = index_of_[place];
        if (index != kNoVertex) return index;
        index = static_cast<std::uint32_t>(mesh.vertex.size());
        places.push_back(place);
        const std::array<float, 3> at = refinement_.position_m(place);
        TubeVertex v{{}, {}, {0, 0, 0, 255}};
        for (std::size_t i = 0; i < 3; ++i)
            v.position_a[i] = static_cast<float>(
                (static_cast<double>(at[i]) - content_.centre_model_m[static_cast<Eigen::Index>(i)]) /
                kAngstromM);
        mesh.vertex.push_back(v);
        length_m_.push_back(0.0F);
        edges_.push_back(0.0F);
        return index;
    };
    refinement_.each_triangle([&](std::uint32_t, const std::array<std::uint32_t, 3>& at) {
        std::array<std::uint32_t, 3> corner{};
        std::array<Vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = vertex(at[k]);
            const auto q = refinement_.position_m(at[k]);
            p[k] = Vec3(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
        }
        const Eigen::Vector3f area = (1e6 * (p[1] - p[0]).cross(p[2] - p[0])).cast<float>();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const auto length = static_cast<float>((p[next] - p[k]).norm());
            for (const std::uint32_t v : {corner[k], corner[next]}) {
                length_m_[v] += length;
                edges_[v] += 1.0F;
            }
            for (int axis = 0; axis < 3; ++axis) mesh.vertex[corner[k]].normal[axis] += area[axis];
        }
        mesh.index.insert(mesh.index.end(), corner.begin(), corner.end());
    });
    for (const std::uint32_t place : places) index_of_[place] = kNoVertex;
    if (mesh.vertex.empty()) return mesh;
    for (std::size_t v = 0; v < length_m_.size(); ++v) length_m_[v] /= std::max(edges_[v], 1.0F);
    std::vector<float> sorted = length_m_;
    const auto at = [&](double share) {
        const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
        std::nth_element(sorted.begin(), sorted.begin() + n, sorted.end());
        return std::max(static_cast<double>(sorted[static_cast<std::size_t>(n)]), 1e-12);
    };
    finest_m = std::exp2(std::floor(std::log2(at(kFinestShare))));
    coarsest_m = std::max(std::exp2(std::ceil(std::log2(at(kCoarsestShare)))), 2.0 * finest_m);
    const double range = std::log2(coarsest_m / finest_m);
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
        TubeVertex& to = mesh.vertex[v];
        Eigen::Map<Eigen::Vector3f> normal(to.normal);
        normal =
            normal.squaredNorm() > 0.0F ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f::UnitY();
        const double over = std::log2(coarsest_m / std::max(static_cast<double>(length_m_[v]), 1e-12));
        std::copy_n(light_viridis(static_cast<float>(over / range)).begin(), 3, to.rgba);
    }
    return mesh;
}

}  // namespace tact
