#include "tests/reproduce/sample_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/isosurface.hpp"

namespace tact::launch {

TriangleMesh open_sheet() {
    constexpr std::uint32_t kLong = 50, kShort = 25;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j < kShort; ++j)
        for (std::uint32_t i = 0; i < kLong; ++i) {
            const double u = static_cast<double>(i) / (kLong - 1), v = static_cast<double>(j) / (kShort - 1);
            const double z = 0.13 * std::cos(2.4 * std::numbers::pi * u) * (1.0 - 0.4 * v) + 0.1 * v * v;
            for (const double x : {u, 0.6 * v, z}) mesh.position_m.push_back(static_cast<float>(x));
        }
    for (std::uint32_t j = 0; j + 1 < kShort; ++j)
        for (std::uint32_t i = 0; i + 1 < kLong; ++i) {
            const std::uint32_t a = j * kLong + i, b = a + 1, c = a + kLong, d = c + 1;
            for (const std::uint32_t corner : {a, b, d, a, d, c}) mesh.triangle.push_back(corner);
        }
    return mesh;
}

namespace {

// Domains of one subunit, by height above the plane between the rings: equatorial, intermediate and apical domain,
// and the peak at the end. Distance from the axis, height and width of the Gaussian in angstrom; weight.
struct Domain {
    double out_a, up_a, width_a, weight;
};
constexpr std::array<Domain, 5> kSubunit{{{47.0, 14.0, 13.0, 1.0},
                                          {57.0, 30.0, 11.0, 1.0},
                                          {50.0, 48.0, 12.0, 1.0},
                                          {40.0, 62.0, 10.0, 0.95},
                                          {34.0, 78.0, 8.0, 0.9}}};

DensityGrid chaperonin_map(double step_a) {
    DensityGrid g;
    const double half_a = 96.0, tall_a = 108.0;
    const auto count = [step_a](double half) {
        return 2 * static_cast<std::uint32_t>(std::ceil(half / step_a)) + 1;
    };
    g.size = {count(half_a), count(half_a), count(tall_a)};
    g.spacing_m = Vec3::Constant(step_a * kAngstromM);
    g.origin_m = -0.5 * Vec3(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1) * step_a * kAngstromM;
    g.values.assign(g.count(), 0.0F);
    for (int ring = 0; ring < 2; ++ring)
        for (int k = 0; k < 8; ++k)
            for (std::size_t d = 0; d < kSubunit.size(); ++d) {
                const Domain& m = kSubunit[d];
                const double side = ring == 0 ? 1.0 : -1.0;
                // The subunits of the two rings are back to back and slightly tilted.
                const double angle = 2.0 * std::numbers::pi * k / 8.0 + side * 0.003 * m.up_a;
                const Vec3 at =
                    Vec3(m.out_a * std::cos(angle), m.out_a * std::sin(angle), side * m.up_a) * kAngstromM;
                const double reach_m = 3.2 * m.width_a * kAngstromM;
                std::array<std::uint32_t, 3> from{}, to{};
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto e = static_cast<Eigen::Index>(i);
                    const double low = (at[e] - reach_m - g.origin_m[e]) / g.spacing_m[e];
                    const double high = (at[e] + reach_m - g.origin_m[e]) / g.spacing_m[e];
                    from[i] = static_cast<std::uint32_t>(std::clamp(std::ceil(low), 0.0, g.size[i] - 1.0));
                    to[i] = static_cast<std::uint32_t>(std::clamp(std::floor(high), 0.0, g.size[i] - 1.0));
                }
                for (std::uint32_t z = from[2]; z <= to[2]; ++z)
                    for (std::uint32_t y = from[1]; y <= to[1]; ++y)
                        for (std::uint32_t x = from[0]; x <= to[0]; ++x) {
                            const Vec3 p = g.origin_m + Vec3(x, y, z).cwiseProduct(g.spacing_m);
                            const double r2 =
                                (p - at).squaredNorm() / (m.width_a * m.width_a * kAngstromM * kAngstromM);
                            g.values[(std::size_t{z} * g.size[1] + y) * g.size[0] + x] +=
                                static_cast<float>(m.weight * std::exp(-0.5 * r2));
                        }
            }
    return g;
}

}  // namespace

TriangleMesh chaperonin(std::size_t vertices_min) {
    constexpr double kLevel = 0.6;
    double step_a = 12.0;
    TriangleMesh mesh = isosurface(chaperonin_map(step_a), kLevel);
    for (int i = 0; i < 60 && mesh.vertices() < vertices_min; ++i) {
        // The number of vertices grows with 1 / step^2. Each iteration reduces the step by at least 0.5 %.
        const double times = std::sqrt(static_cast<double>(std::max<std::size_t>(mesh.vertices(), 100)) /
                                       static_cast<double>(vertices_min));
        step_a *= std::min(times, 0.995);
        mesh = isosurface(chaperonin_map(step_a), kLevel);
    }
    return mesh;
}

}  // namespace tact::launch
