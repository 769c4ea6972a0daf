// A vector limited to a maximum length, with its direction kept.
#pragma once

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

[[nodiscard]] inline Vec3 shortened(const Vec3& v, double most) noexcept TACT_RT {
    const double size = v.stableNorm();
    return size > most ? Vec3(v * (most / size)) : v;
}

}  // namespace tact
