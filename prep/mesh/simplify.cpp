#include "prep/mesh/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "prep/mesh/contractor.hpp"

namespace tact {
namespace {

void check(const TriangleMesh& mesh) {
    const auto refuse = [](const std::string& why) {
        throw StartupError("simplify a mesh", why, "repair the mesh, or export it again");
    };
    const std::size_t n = mesh.vertices();
    if (n >= kNoIndex / 4 || mesh.triangles() >= kNoIndex / 4)
        refuse("the mesh has more than 2^30 vertices or triangles");
    for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
        if (mesh.triangle[i] >= n)
            refuse("triangle " + std::to_string(i / 3) + " refers to vertex " +
                   std::to_string(mesh.triangle[i]) + ", but the mesh has " + std::to_string(n));
    }
    for (std::size_t i = 0; i < mesh.position_m.size(); ++i) {
        if (!(std::abs(mesh.position_m[i]) <= 1e6F))
            refuse("vertex " + std::to_string(i / 3) + " has a coordinate that is not finite");
    }
}

}  // namespace

Simplified simplify(const TriangleMesh& mesh, const SimplifySettings& settings, const Progress& progress) {
    check(mesh);
    return Contractor(mesh, settings).run(progress);
}

TriangleMesh cleaned(const TriangleMesh& mesh) {
    check(mesh);
    std::vector<std::array<std::uint32_t, 3>> key;  // sorted corners, and the triangle of each key
    std::vector<std::uint32_t> order;
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
        std::array<std::uint32_t, 3> v{mesh.triangle[3 * t], mesh.triangle[3 * t + 1],
                                       mesh.triangle[3 * t + 2]};
        std::sort(v.begin(), v.end());
        key.push_back(v);
        if (v[0] != v[1] && v[1] != v[2]) order.push_back(t);
    }
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return key[a] < key[b]; });
    order.erase(std::unique(order.begin(), order.end(), [&](auto a, auto b) { return key[a] == key[b]; }),
                order.end());
    std::sort(order.begin(), order.end());
    TriangleMesh out;
    std::vector<std::uint32_t> place(mesh.vertices(), kNoIndex);
    for (const std::uint32_t t : order) {
        for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c) place[mesh.triangle[c]] = 0;
    }
    std::uint32_t next = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == kNoIndex) continue;
        place[v] = next++;
        out.position_m.insert(out.position_m.end(), &mesh.position_m[3 * v], &mesh.position_m[3 * v] + 3);
    }
    for (const std::uint32_t t : order) {
        for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c)
            out.triangle.push_back(place[mesh.triangle[c]]);
    }
    return out;
}

}  // namespace tact
