#include "prep/synthetic/rough_torus.hpp"

#include <cmath>
#include <numbers>

namespace tact {

TriangleMesh rough_torus(std::uint32_t n, std::uint32_t m) {
    TriangleMesh mesh;
    mesh.position_m.reserve(std::size_t{3} * n * m);
    mesh.triangle.reserve(std::size_t{6} * n * m);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2.0 * std::numbers::pi * i / n, v = 2.0 * std::numbers::pi * j / m;
            double r = 0.3;
            for (int k = 0; k < 7; ++k)
                r +=
                    0.02 / (1 << k) * std::sin((3 << k) * u + 1.7 * k) * std::sin((2 << k) * v + 0.9 * k * k);
            const double d = 1.0 + r * std::cos(v);
            for (const double x : {d * std::cos(u), d * std::sin(u), r * std::sin(v)})
                mesh.position_m.push_back(static_cast<float>(x));
            const std::uint32_t a = i * m + j, b = (i + 1) % n * m + j, c = i * m + (j + 1) % m,
                                e = (i + 1) % n * m + (j + 1) % m;
            mesh.triangle.insert(mesh.triangle.end(), {a, b, e, a, e, c});
        }
    }
    return mesh;
}

}  // namespace tact
