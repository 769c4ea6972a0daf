// A burr's head is a surface of revolution whose radius rises and falls ten times around: cutting edges that lean
// against the rotation and run along the head in a slight helix, as on a cutting burr.
#include "gui/drilling/drill_tools.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "gui/render/revolve.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr Rgb8 kSteel{190, 196, 206}, kEdgeSteel{232, 236, 242}, kGroove{122, 127, 138}, kGrip{58, 66, 80},
    kInside{24, 26, 30}, kBond{148, 128, 84}, kGrain{238, 226, 188};
constexpr int kFlutes = 10, kAround = 64, kRings = 20;
constexpr float kGrooveDepth = 0.10F, kTwistRad = 0.9F;
constexpr float kPi = std::numbers::pi_v<float>;

float in_a(double m) { return static_cast<float>(m / kAngstromM); }

// Half of the head's profile for s from 0 (far end) to 1 (start of the shaft): radius and position along z.
struct Profile {
    float radius, z;
};
Profile profile(const DrawnDrillTool& t, float s) {
    const float r = in_a(t.radius_m), half = 0.5F * in_a(t.length_m), tip = in_a(t.tip_radius_m);
    if (t.head == DrillHead::sphere) return {r * std::sin(kPi * s), -r * std::cos(kPi * s)};
    // Round at both ends, straight between.
    const float low = t.head == DrillHead::cone ? std::min(tip, r) : r;
    const float z0 = -half + low, z1 = half - r;
    if (s < 0.25F) {
        const float a = 2.0F * kPi * s;
        return {low * std::sin(a), z0 - low * std::cos(a)};
    }
    if (s > 0.75F) {
        const float a = 0.5F * kPi + 2.0F * kPi * (s - 0.75F);
        return {r * std::sin(a), z1 - r * std::cos(a)};
    }
    const float u = 2.0F * (s - 0.25F);
    return {low + u * (r - low), z0 + u * (z1 - z0)};
}

// 0 in a groove, 1 on an edge: rises slowly and falls steeply.
float flute(float turns) {
    const float u = turns - std::floor(turns);
    return u < 0.75F ? u / 0.75F : (1.0F - u) / 0.25F;
}

Rgb8 blend(const Rgb8& a, const Rgb8& b, float share) {
    Rgb8 c{};
    for (std::size_t i = 0; i < 3; ++i)
        c[i] = static_cast<std::uint8_t>(static_cast<float>(a[i]) +
                                         share * (static_cast<float>(b[i]) - static_cast<float>(a[i])));
    return c;
}

// Grains of diamond in their bond: from 0 to 1, another number in each place.
float grain(int ring, int column) {
    std::uint32_t n = static_cast<std::uint32_t>(ring) * 0x9E3779B1U +
                      static_cast<std::uint32_t>(column % kAround) * 0x85EBCA77U;
    n = (n ^ (n >> 15U)) * 0x2C1B3C6DU;
    return static_cast<float>((n >> 16U) & 0xFFU) / 255.0F;
}

void add_head(TubeMesh& mesh, const DrawnDrillTool& t) {
    const auto point = [&](float s, float around) {
        const Profile p = profile(t, s);
        const float ridge = flute(kFlutes * around + kTwistRad * s * kFlutes / (2.0F * kPi));
        // The grooves end at both poles.
        const float deep = kGrooveDepth * std::min(1.0F, 4.0F * std::min(s, 1.0F - s));
        const float r = t.diamond ? p.radius : p.radius * (1.0F - deep * (1.0F - ridge));
        const float a = 2.0F * kPi * around;
        return Eigen::Vector3f(r * std::cos(a), r * std::sin(a), p.z);
    };
    const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
    constexpr float kStep = 1e-3F;
    for (int i = 0; i <= kRings; ++i)
        for (int k = 0; k < kAround; ++k) {
            const float s = std::clamp(static_cast<float>(i) / kRings, 0.01F, 0.99F);
            const float around = static_cast<float>(k) / kAround;
            const Eigen::Vector3f p = point(static_cast<float>(i) / kRings, around);
            const Eigen::Vector3f along = point(s + kStep, around) - point(s - kStep, around);
            const Eigen::Vector3f across = point(s, around + kStep) - point(s, around - kStep);
            const Eigen::Vector3f n = across.cross(along).normalized();
            const float ridge = flute(kFlutes * around + kTwistRad * s * kFlutes / (2.0F * kPi));
            const Rgb8 c =
                t.diamond ? blend(kBond, kGrain, grain(i, k)) : blend(kGroove, kEdgeSteel, ridge * ridge);
            mesh.vertex.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {c[0], c[1], c[2], 255}});
        }
    for (std::uint32_t i = 0; i < kRings; ++i)
        for (std::uint32_t k = 0; k < kAround; ++k) {
            const std::uint32_t a = first + i * kAround + k, b = first + i * kAround + (k + 1) % kAround;
            mesh.index.insert(mesh.index.end(), {a, b, a + kAround, b, b + kAround, a + kAround});
        }
}

}  // namespace

DrillToolMesh build_drill_tool(const DrawnDrillTool& t) {
    DrillToolMesh tool;
    TubeMesh& mesh = tool.rest;
    if (!(t.radius_m > 0.0)) return tool;
    const Eigen::Vector3f z = Eigen::Vector3f::UnitZ(), origin = Eigen::Vector3f::Zero();
    const float r = in_a(t.radius_m);
    if (t.head == DrillHead::tube) {
        // Open at its tip: the wall, its rim, and the dark inside.
        const float wall = 0.72F * r, end = std::max(in_a(t.shaft_length_m), 30.0F * r);
        add_revolved(mesh, std::array<ProfileRing, 2>{{{-r, r, 0.0F}, {end, 1.35F * r, 0.0F}}}, origin, z,
                     kSteel);
        add_revolved(mesh, std::array<ProfileRing, 2>{{{-r, wall, -1.0F}, {-r, r, -1.0F}}}, origin, z,
                     kEdgeSteel);
        add_revolved(
            mesh,
            std::array<ProfileRing, 3>{{{-r, wall, 0.0F}, {2.0F * r, wall, 0.0F}, {2.0F * r, 0.0F, -1.0F}}},
            origin, z, kInside);
        add_revolved(mesh,
                     std::array<ProfileRing, 5>{{{end, 1.35F * r, -1.0F},
                                                 {end, 2.6F * r, -0.6F},
                                                 {end + 1.5F * r, 3.0F * r, 0.0F},
                                                 {end + 20.0F * r, 3.0F * r, 0.0F},
                                                 {end + 21.0F * r, 0.0F, 1.0F}}},
                     origin, z, kGrip);
        return tool;
    }
    add_head(tool.head, t);
    const float top = profile(t, 1.0F).z, shaft = in_a(t.shaft_radius_m);
    if (!(shaft > 0.0F)) return tool;
    // The shaft, its collet and the handpiece, with the proportions of a drill.
    const float begin = top - 0.35F * r, end = std::max(in_a(t.shaft_length_m), top + 14.0F * shaft);
    add_revolved(mesh,
                 std::array<ProfileRing, 4>{{{begin, 0.55F * std::min(r, shaft), 0.0F},
                                             {top + 0.8F * shaft, shaft, -0.3F},
                                             {top + 0.8F * shaft, shaft, 0.0F},
                                             {end, shaft, 0.0F}}},
                 origin, z, kSteel);
    add_revolved(mesh,
                 std::array<ProfileRing, 6>{{{end, shaft, -1.0F},
                                             {end, 1.5F * shaft, -1.0F},
                                             {end, 1.5F * shaft, -0.3F},
                                             {end + 6.0F * shaft, 3.2F * shaft, -0.4F},
                                             {end + 6.0F * shaft, 3.2F * shaft, 0.0F},
                                             {end + 9.0F * shaft, 3.4F * shaft, 0.0F}}},
                 origin, z, kSteel);
    add_revolved(mesh,
                 std::array<ProfileRing, 4>{{{end + 9.0F * shaft, 3.4F * shaft, 0.0F},
                                             {end + 45.0F * shaft, 3.8F * shaft, 0.0F},
                                             {end + 47.0F * shaft, 2.8F * shaft, 0.8F},
                                             {end + 47.0F * shaft, 0.0F, 1.0F}}},
                 origin, z, kGrip);
    return tool;
}

}  // namespace tact
