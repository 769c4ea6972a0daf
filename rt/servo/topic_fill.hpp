// Converts vectors and durations to topic members.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact::servo {

inline void put(double (&to)[3], const Vec3& from) noexcept TACT_RT { std::copy_n(from.data(), 3, to); }
inline void put(float (&to)[3], const Vec3& from) noexcept TACT_RT {
    for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}
inline void put(double (&to)[4], const Quat& from) noexcept TACT_RT {
    std::copy_n(from.coeffs().data(), 4, to);
}
// Clamped to 0 to 2 s, in ns.
[[nodiscard]] inline std::int32_t cut_ns(Duration d) noexcept TACT_RT {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(d.count(), 0, 2'000'000'000));
}

}  // namespace tact::servo
