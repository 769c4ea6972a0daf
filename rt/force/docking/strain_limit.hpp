// Keeps the strain of a bending body below a limit: the largest relative change of the length of its links (flexible_parts.hpp).
//
// Measure   once per pass, with all nodes bent by the same amplitudes
// Near      links within kNear of the limit, at most kListMost of them, each give a half-space of amplitudes, with its derivative at the
//           measurement: a step is projected onto them, so the body slides along the limit
// Others    until the next measurement the amplitudes change by no more than what keeps all other links below the limit, by
//           FlexibleParts::strain_per_m
// So        the strain exceeds the limit by the curvature of a near link within one pass alone: less than kSlack
// Runs on   servo thread; constant time, no allocation
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ipc/base/rt.hpp"
#include "rt/force/docking/flexible_parts.hpp"

namespace tact {

class StrainLimit {
public:
    static constexpr double kMost = 0.6, kNear = 0.06, kSlack = 0.01;
    static constexpr std::size_t kListMost = 16;

    // Another body, or another start of a pass.
    void restart(std::span<const float> amplitude_m) noexcept TACT_RT;
    // Measures the links whose second end is before a node; in a pass, with ascending nodes.
    void measure(const FlexibleParts& parts, const NodeVectors& shift_m, std::size_t before) noexcept TACT_RT;
    // All links are measured, at these amplitudes.
    void end_pass(const FlexibleParts& parts, const NodeVectors& shift_m,
                  std::span<const float> amplitude_m) noexcept TACT_RT;
    // Shortens and turns a step of the amplitudes, one per mode. False: there is no step.
    [[nodiscard]] bool shorten(const FlexibleParts& parts, std::span<const float> amplitude_m,
                               std::span<double> step_m) const noexcept TACT_RT;

    // Of the last pass.
    [[nodiscard]] double strain() const noexcept TACT_RT { return strain_; }

private:
    struct Near {
        std::size_t link = 0;
        double strain = 0.0;
        std::array<double, kModesMax> rise{};  // of the strain per amplitude
    };

    void take(std::size_t link, double strain) noexcept;

    std::array<float, kModesMax> at_m_{};  // of the last pass
    double strain_ = 0.0, others_ = 0.0;   // of all links, and of those that are not near
    std::array<Near, kListMost> near_{};
    std::size_t count_ = 0;
    // Of this pass.
    std::array<Near, kListMost> next_near_{};
    std::size_t next_count_ = 0, next_link_ = 0;
    double next_strain_ = 0.0, next_others_ = 0.0;
};

}  // namespace tact
