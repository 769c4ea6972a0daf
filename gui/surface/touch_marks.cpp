#include "gui/surface/touch_marks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/render/arrow.hpp"
#include "gui/render/revolve.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr float kProbeLeast = 0.014F, kSpring = 0.0035F, kArrow = 0.009F;  // in sizes of the scene
constexpr int kRings = 9;

void add_ball(TubeMesh& mesh, const Eigen::Vector3f& centre_a, float radius_a) {
    std::array<ProfileRing, kRings> ring;
    for (int i = 0; i < kRings; ++i) {
        const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / (kRings - 1);
        ring[static_cast<std::size_t>(i)] = {-std::cos(angle) * radius_a, std::sin(angle) * radius_a,
                                             -std::cos(angle)};
    }
    add_revolved(mesh, ring, centre_a, Eigen::Vector3f::UnitZ(), kProbeColour);
}

void add_spring(TubeMesh& mesh, const Eigen::Vector3f& from_a, const Eigen::Vector3f& to_a, float thick_a) {
    const Eigen::Vector3f way = to_a - from_a;
    const float length = way.norm();
    if (!(length > thick_a)) return;
    const std::array<ProfileRing, 2> ring{{{0.0F, thick_a, 0.0F}, {length, thick_a, 0.0F}}};
    add_revolved(mesh, ring, from_a, way / length, kProbeColour);
}

}  // namespace

TubeMesh build_touch_marks(const DrawnTouch& touch, const Vec3& centre_model_m, float size_a,
                           float arrow_a_per_n) {
    TubeMesh mesh;
    const auto scene = [&](const Vec3& p_m) -> Eigen::Vector3f {
        return ((p_m - centre_model_m) / kAngstromM).cast<float>();
    };
    const Eigen::Vector3f probe = scene(touch.probe_model_m), proxy = scene(touch.proxy_model_m);
    if (!probe.allFinite() || !proxy.allFinite() || !(size_a > 0.0F)) return mesh;
    const auto radius = static_cast<float>(touch.radius_model_m / kAngstromM);
    add_ball(mesh, probe, std::clamp(radius, kProbeLeast * size_a, size_a));
    add_spring(mesh, probe, proxy, kSpring * size_a);
    for (std::uint32_t i = 0; i < std::min<std::uint32_t>(touch.planes, 3); ++i) {
        const Eigen::Vector3f along = touch.normal[i].cast<float>();
        const float push = static_cast<float>(touch.push_n[i]) * arrow_a_per_n;
        if (!along.allFinite() || !std::isfinite(push) || push <= 0.0F) continue;
        const TubeMesh arrow = build_arrow(proxy - radius * along, std::min(push, 3.0F * size_a) * along,
                                           kArrow * size_a, kNormalColour);
        const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
        mesh.vertex.insert(mesh.vertex.end(), arrow.vertex.begin(), arrow.vertex.end());
        for (const std::uint32_t v : arrow.index) mesh.index.push_back(first + v);
    }
    return mesh;
}

}  // namespace tact
