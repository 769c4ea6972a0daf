// Nearest-vector search among many moving vectors: a uniform grid of linked lists.
//
// Unit     the caller's. Thread: one per object.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

class VectorGrid {
public:
    struct Near {
        double distance_2;
        std::uint32_t index;
    };

    // low and high bound all query points; the outermost cells hold the vectors outside.
    VectorGrid(std::vector<Vec3> vectors, const Vec3& low, const Vec3& high);

    [[nodiscard]] std::size_t size() const { return at_.size(); }
    [[nodiscard]] const Vec3& operator[](std::size_t i) const { return at_[i]; }
    void move(std::uint32_t index, const Vec3& to);

    // Fills found, nearest first, ties by index; returns the number found (all vectors, or found.size()).
    std::size_t nearest(const Vec3& point, std::span<Near> found) const;

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
    [[nodiscard]] std::array<int, 3> cell(const Vec3& point) const;
    [[nodiscard]] std::size_t row(const std::array<int, 3>& c) const {
        return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(count_[1]) +
                static_cast<std::size_t>(c[1])) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(c[0]);
    }
    void link(std::uint32_t index);
    void unlink(std::uint32_t index);

    std::vector<Vec3> at_;
    Vec3 low_;
    double width_ = 1.0;  // of a cell
    std::array<int, 3> count_{};
    std::vector<std::uint32_t> head_, next_, before_;
    std::vector<std::size_t> home_;  // cell of each vector
};

}  // namespace tact
