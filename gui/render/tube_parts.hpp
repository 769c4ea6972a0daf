// Parts of tubes and ribbons: the curve, rings of vertices, ends.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gui/render/tube.hpp"

namespace tact {

[[nodiscard]] Eigen::Vector3f point_a(const Structure& s, std::size_t i);
// Between the points i and i + 1.
[[nodiscard]] Eigen::Vector3f catmull_rom(const std::vector<Eigen::Vector3f>& points, std::size_t i, float t);
// The half axes of the ring, an ellipse.
void add_ring(TubeMesh& mesh, const Eigen::Vector3f& centre, const Eigen::Vector3f& u,
              const Eigen::Vector3f& v, int sides, const Rgb8& colour);
void join_rings(TubeMesh& mesh, std::uint32_t a, std::uint32_t b, int sides);
void close_end(TubeMesh& mesh, const Eigen::Vector3f& tip, const Eigen::Vector3f& normal, std::uint32_t ring,
               int sides, bool last, const Rgb8& colour);

}  // namespace tact
