#include "rt/force/surface/all_triangles.hpp"

#include <algorithm>
#include <array>

namespace tact {
namespace {

constexpr double kBoundSlack = 1e-5;  // relative rounding of distances in single precision

// Calls see(first, lanes, queries) for sixteen triangles at a time, until it returns false.
template <typename See>
void query_all(const QueryKernel& kernel, QueryJob& job, std::uint32_t all, const See& see) noexcept {
    TriangleQueries seen;
    std::array<std::uint32_t, kLooks> number;  // filled before it is read
    job.triangle = number.data();
    for (std::uint32_t first = 0; first < all; first += kLooks) {
        for (std::uint32_t k = 0; k < kLooks; ++k) number[k] = std::min(first + k, all - 1);
        kernel.query(job, seen);
        if (!see(first, std::min<std::uint32_t>(kLooks, all - first), seen)) return;
    }
}

}  // namespace

bool AllTriangles::near(const Vec3& place_m, double radius_m, std::span<std::uint32_t> out,
                        std::size_t& count) const noexcept {
    QueryJob job = mesh_.query_job(place_m);
    job.limit = static_cast<float>(radius_m * (1.0 + kBoundSlack));
    count = 0;
    bool room = true;
    query_all(*kernel_, job, static_cast<std::uint32_t>(mesh_.triangles()),
              [&](std::uint32_t first, std::uint32_t lanes, const TriangleQueries& seen) {
                  for (std::uint32_t k = 0; k < lanes && room; ++k) {
                      if ((seen.near >> k & 1U) == 0) continue;
                      room = count < out.size();
                      if (room) out[count++] = first + k;
                  }
                  return room;
              });
    return room;
}

double AllTriangles::clearance_m(const Vec3& place_m, double at_most_m) const noexcept {
    QueryJob job = mesh_.query_job(place_m);
    job.limit = static_cast<float>(at_most_m);
    auto least = static_cast<float>(at_most_m);
    query_all(*kernel_, job, static_cast<std::uint32_t>(mesh_.triangles()),
              [&](std::uint32_t, std::uint32_t lanes, const TriangleQueries& seen) {
                  for (std::uint32_t k = 0; k < lanes; ++k) least = std::min(least, seen.distance[k]);
                  return true;
              });
    return static_cast<double>(least) * (1.0 - kBoundSlack);
}

}  // namespace tact
