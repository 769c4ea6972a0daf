// Padding and storage of a map's spline coefficients. Private to ipc/scene/density.
#pragma once

#include <array>
#include <cstdint>

namespace tact {

inline constexpr std::int32_t kDensityReach = 8;  // coefficients kept beyond the box
inline constexpr std::int32_t kDensityZero = 4;   // layers of zeros beyond them
inline constexpr std::int32_t kDensityPad = kDensityReach + kDensityZero;

// See density_kernels.hpp; in floats.
struct DensityLayout {
    std::int32_t step, row_stride, plane_stride;  // step: of x between rows
};

inline DensityLayout density_layout(const std::array<std::int32_t, 3>& padded, bool windows) noexcept {
    const std::int32_t step = windows ? 1 : 4, rows = (padded[0] + step - 1) / step;
    return {step, 4 * padded[1], 4 * padded[1] * rows};
}

}  // namespace tact
