#include "prep/synthetic/rough_sphere.hpp"

#include <array>
#include <cmath>
#include <unordered_map>

namespace tact {
namespace {

constexpr double kTerrainM = 0.12;

// Uniform in -1 to 1, a hash of a grid point (finalizer of splitmix64).
double grid_value(std::int64_t i, std::int64_t j, std::int64_t k) {
    std::uint64_t z = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL +
                      static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL +
                      static_cast<std::uint64_t>(k) * 0x165667B19E3779F9ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

// Interpolates the eight grid points around p with continuous slope and curvature.
double value_noise(const Vec3& p) {
    std::array<std::int64_t, 3> cell;
    Vec3 s;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor(p[axis]), t = p[axis] - low;
        cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(low);
        s[axis] = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
        sum += (a != 0 ? s.x() : 1.0 - s.x()) * (b != 0 ? s.y() : 1.0 - s.y()) *
               (c != 0 ? s.z() : 1.0 - s.z()) * grid_value(cell[0] + a, cell[1] + b, cell[2] + c);
    }
    return sum;
}

double octaves(Vec3 p) {
    double sum = 0.0, height = 1.0;
    for (int i = 0; i < 5; ++i, height *= 0.5) {
        sum += height * value_noise(p);
        p = 2.03 * p + Vec3(17.1, 3.7, 9.2);
    }
    return sum;
}

void put(TriangleMesh& mesh, const Vec3& p) {
    for (const double x : {p.x(), p.y(), p.z()}) mesh.position_m.push_back(static_cast<float>(x));
}

template <class RadiusM>
TriangleMesh sphere_of(std::uint32_t parts, RadiusM&& radius_m) {
    const double t = 0.5 * (1.0 + std::sqrt(5.0));
    const std::array<Vec3, 12> corner{Vec3(-1, t, 0), Vec3(1, t, 0), Vec3(-1, -t, 0), Vec3(1, -t, 0),
                                      Vec3(0, -1, t), Vec3(0, 1, t), Vec3(0, -1, -t), Vec3(0, 1, -t),
                                      Vec3(t, 0, -1), Vec3(t, 0, 1), Vec3(-t, 0, -1), Vec3(-t, 0, 1)};
    constexpr std::array<std::array<std::uint32_t, 3>, 20> kFaces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    TriangleMesh mesh;
    mesh.position_m.reserve(std::size_t{30} * parts * parts + 6);
    mesh.triangle.reserve(std::size_t{60} * parts * parts);
    std::unordered_map<std::uint64_t, std::uint32_t> shared;  // vertices on edges of the icosahedron
    std::vector<std::uint32_t> row_before, row;
    for (const auto& face : kFaces) {
        const auto vertex = [&](std::uint32_t i,
                                std::uint32_t j) {  // i parts from corner 0, j of them towards 2
            const std::array<std::uint32_t, 3> weight{parts - i, i - j, j};
            std::uint64_t key = 0;
            std::uint32_t least = 13, used = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                if (weight[k] == 0) continue;
                ++used;
                least = std::min(least, face[k]);
            }
            for (std::size_t k = 0; k < 3; ++k) {
                if (weight[k] == 0) continue;
                if (face[k] == least)
                    key |= std::uint64_t{least} << 40 | weight[k];
                else
                    key |= std::uint64_t{face[k] + 1} << 48;
            }
            const auto next = static_cast<std::uint32_t>(mesh.vertices());
            if (used < 3) {
                const auto [at, fresh] = shared.emplace(key, next);
                if (!fresh) return at->second;
            }
            const Vec3 direction =
                (weight[0] * corner[face[0]] + weight[1] * corner[face[1]] + weight[2] * corner[face[2]])
                    .normalized();
            put(mesh, radius_m(direction) * direction);
            return next;
        };
        row_before.assign(1, vertex(0, 0));
        for (std::uint32_t i = 1; i <= parts; ++i, row_before.swap(row)) {
            row.clear();
            for (std::uint32_t j = 0; j <= i; ++j) row.push_back(vertex(i, j));
            for (std::uint32_t j = 0; j < i; ++j) {
                mesh.triangle.insert(mesh.triangle.end(), {row_before[j], row[j], row[j + 1]});
                if (j + 1 < i)
                    mesh.triangle.insert(mesh.triangle.end(), {row_before[j], row[j + 1], row_before[j + 1]});
            }
        }
    }
    return mesh;
}

}  // namespace

double rough_radius_m(const Vec3& direction) { return kRoughSphereM + 0.0025 * octaves(4.0 * direction); }

double rough_height_m(double x_m, double z_m) { return 0.006 * octaves(Vec3(35.0 * x_m, 0.5, 35.0 * z_m)); }

TriangleMesh rough_sphere(std::uint32_t parts) { return sphere_of(parts, rough_radius_m); }

TriangleMesh smooth_sphere(std::uint32_t parts) {
    return sphere_of(parts, [](const Vec3&) { return kRoughSphereM; });
}

TriangleMesh rough_terrain(std::uint32_t parts) {
    TriangleMesh mesh;
    const auto at = [&](std::uint32_t i) { return kTerrainM * (static_cast<double>(i) / parts - 0.5); };
    for (std::uint32_t i = 0; i <= parts; ++i)
        for (std::uint32_t j = 0; j <= parts; ++j) put(mesh, {at(i), rough_height_m(at(i), at(j)), at(j)});
    const std::uint32_t row = parts + 1;
    for (std::uint32_t i = 0; i < parts; ++i) {
        for (std::uint32_t j = 0; j < parts; ++j) {
            const std::uint32_t a = i * row + j;
            mesh.triangle.insert(mesh.triangle.end(), {a, a + 1, a + row + 1, a, a + row + 1, a + row});
        }
    }
    return mesh;
}

}  // namespace tact
