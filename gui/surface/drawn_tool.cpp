#include "gui/surface/drawn_tool.hpp"

#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr float kSmoothCosine = 0.82F;

}  // namespace

TubeMesh build_drawn_tool(const TouchTool& tool) {
    TubeMesh mesh;
    const auto at = [&](std::uint32_t v) {
        return Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(tool.drawn_m.data() + std::size_t{3} * v) /
                               static_cast<float>(kAngstromM));
    };
    const auto doubled = [&](std::size_t t) {
        const Eigen::Vector3f a = at(tool.drawn[t]);
        return Eigen::Vector3f((at(tool.drawn[t + 1]) - a).cross(at(tool.drawn[t + 2]) - a));
    };
    std::vector<Eigen::Vector3f> mean(tool.drawn_m.size() / 3, Eigen::Vector3f::Zero());
    for (std::size_t t = 0; t < tool.drawn.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) mean[tool.drawn[t + k]] += doubled(t);
    }
    mesh.vertex.reserve(tool.drawn.size());
    for (std::size_t t = 0; t < tool.drawn.size(); t += 3) {
        const Eigen::Vector3f facet = doubled(t).normalized();
        if (!facet.allFinite()) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector3f p = at(tool.drawn[t + k]), smooth = mean[tool.drawn[t + k]].normalized();
            const Eigen::Vector3f n = smooth.dot(facet) > kSmoothCosine ? smooth : facet;
            mesh.index.push_back(static_cast<std::uint32_t>(mesh.vertex.size()));
            mesh.vertex.push_back({{p.x(), p.y(), p.z()},
                                   {n.x(), n.y(), n.z()},
                                   {kToolColour[0], kToolColour[1], kToolColour[2], 255}});
        }
    }
    return mesh;
}

}  // namespace tact
