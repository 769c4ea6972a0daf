// A number that differs, for practical purposes, whenever what it was made of differs: to see whether a view has changed.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/base/pose.hpp"

namespace tact {

// FNV-1a, 64 bits.
class ContentKey {
public:
    template <class T>
    requires(std::is_integral_v<T> || std::is_enum_v<T> ||
             std::is_floating_point_v<T>) void add(T value) noexcept {
        const auto* const byte = reinterpret_cast<const unsigned char*>(&value);
        for (std::size_t i = 0; i < sizeof(T); ++i) key_ = (key_ ^ byte[i]) * 0x100000001B3ULL;
    }
    // To the nearest multiple of `step`, so that noise does not count.
    void add_rounded(double value, double step) noexcept {
        add(static_cast<std::int64_t>(std::llround(value / step)));
    }
    // To a fiftieth of an ångström, and a thousandth of a degree.
    void add(const Pose& pose) noexcept {
        for (int i = 0; i < 3; ++i) add_rounded(pose.p_m[i], 2e-12);
        for (int i = 0; i < 4; ++i) add_rounded(pose.q.coeffs()[i], 1e-5);
    }
    [[nodiscard]] std::uint64_t value() const noexcept { return key_; }

private:
    std::uint64_t key_ = 0xCBF29CE484222325ULL;
};

}  // namespace tact
