// Finds points that are near each other: for each point i, up to `count` points j > i within a distance, nearest first.
//
// Bounds  compares at most 512 points with each, however dense the points.  Cost  one sort of the points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tact {

void near_pairs(std::span<const Eigen::Vector3f> point, float distance, std::uint32_t count,
                const std::function<void(std::uint32_t i, const std::vector<std::uint32_t>& near)>& take);

}  // namespace tact
