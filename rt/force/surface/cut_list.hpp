// Nodes of a cut with what decides about them, in rows that four at a time are compared with a box.
//
// Order     any; what is removed is replaced by the last one. Who removes tells the other's new place.
// Memory    all taken by the constructor.  Thread  that of the refinement.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/huge_pages.hpp"

namespace tact {

// Of the probe's path; Chebyshev distances, below zero inside.
struct RefineBox {
    std::array<float, 3> centre_m, half_m;
    [[nodiscard]] float distance_m(const std::array<float, 3>& p) const noexcept {
        float most = 0.0F;
        for (std::size_t i = 0; i < 3; ++i) {
            const float d = (p[i] > centre_m[i] ? p[i] - centre_m[i] : centre_m[i] - p[i]) - half_m[i];
            most = i == 0 || d > most ? d : most;
        }
        return most;
    }
    friend bool operator==(const RefineBox&, const RefineBox&) = default;
};

class CutList {
public:
    explicit CutList(std::size_t capacity) {
        const std::size_t room = (capacity + 7) / 4 * 4;
        for (HugeVector<float>& axis : position_m_) axis.resize(room);
        limit_m_.resize(room);
        node_.resize(room);
    }
    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    [[nodiscard]] std::uint32_t node(std::uint32_t place) const noexcept { return node_[place]; }
    void set_limit(std::uint32_t place, float limit_m) noexcept { limit_m_[place] = limit_m; }
    [[nodiscard]] bool within(std::uint32_t place, const RefineBox& box) const noexcept {
        return box.distance_m({position_m_[0][place], position_m_[1][place], position_m_[2][place]}) <
               limit_m_[place];
    }
    // The new one's place.
    std::uint32_t add(std::uint32_t node, const std::array<float, 3>& position_m, float limit_m) noexcept {
        for (std::size_t i = 0; i < 3; ++i) position_m_[i][size_] = position_m[i];
        limit_m_[size_] = limit_m;
        node_[size_] = node;
        return size_++;
    }
    // The node that is at this place now, or `none`.
    std::uint32_t remove(std::uint32_t place, std::uint32_t none) noexcept {
        --size_;
        if (place == size_) return none;
        for (HugeVector<float>& axis : position_m_) axis[place] = axis[size_];
        limit_m_[place] = limit_m_[size_];
        return node_[place] = node_[size_];
    }
    // visit(place) for those that are nearer to the box than their limit, or the others; nothing may be added or
    // removed meanwhile.
    template <class Visit>
    void each(const RefineBox& box, bool nearer, Visit&& visit) const {
        using F4 [[gnu::vector_size(16), gnu::aligned(16)]] = float;
        using L2 [[gnu::vector_size(16)]] = long long;
        const auto over = [&](std::size_t axis, std::uint32_t i) {
            const F4 d = *reinterpret_cast<const F4*>(&position_m_[axis][i]) - box.centre_m[axis];
            return (d > 0.0F ? d : -d) - box.half_m[axis];
        };
        for (std::uint32_t i = 0; i < size_; i += 4) {
            const F4 x = over(0, i), y = over(1, i), z = over(2, i);
            const F4 xy = x > y ? x : y, far = xy > z ? xy : z;
            const auto in = far < *reinterpret_cast<const F4*>(&limit_m_[i]);
            const L2 wanted = reinterpret_cast<L2>(nearer ? in : ~in);
            if ((wanted[0] | wanted[1]) == 0) continue;
            for (std::uint32_t k = 0; k < 4 && i + k < size_; ++k)
                if ((in[k] != 0) == nearer) visit(i + k);
        }
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return 20 * node_.capacity(); }

private:
    std::array<HugeVector<float>, 3> position_m_;
    HugeVector<float> limit_m_;  // to be split where the box is nearer, else merged
    HugeVector<std::uint32_t> node_;
    std::uint32_t size_ = 0;
};

}  // namespace tact
