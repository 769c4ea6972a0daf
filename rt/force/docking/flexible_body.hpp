// Bends the body in the hand along its normal modes, driven by the same density as the force.
//
// Energy    of the bent body: U(pose, a) = -k_E (sum_i w_i rho(x_i(a)) - 1/2 B sum_k c_k a_k^2), the energy of the docking force with the
//           points displaced by the modes, and a spring for each mode. c_k = kSoftness times FlexibleParts::spring, B the level bound of the
//           density's second derivatives (LevelMetrics::bends), so that a bend by a resolution's width is felt but possible
// Motion    downhill without inertia: da/dt = kRatePerS / B * (-dU/da) / k_E, no faster than kSpeedMost. A step that would raise the
//           energy is not made. So bending only takes energy out: whatever the hand does, it gets no more back than it put in
// Strain    stays below a limit (strain_limit.hpp)
// Reach     RMSD at most kRmsdMost
// Slices    a step bends an eighth of the points of each level, sums the forces of an eighth of those of the levels in use, and projects
//           an eighth of the residues' forces on the modes. So the drive of the modes is at most two passes, 16 steps, old.
//           No clock and no deadline, so that runs repeat exactly
// Off       the body returns to its own shape within about a second
// Frame     body, metres; gradients in sigma per model metre
// Runs on   servo thread; no allocation after construction
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/rt.hpp"
#include "rt/force/docking/flexible_parts.hpp"
#include "rt/force/docking/level_blend.hpp"
#include "rt/force/docking/strain_limit.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// Amplitudes of a body, metres.
struct BodyShape {
    std::uint32_t id = 0;  // of the body; 0: unused
    std::array<float, kModesMax> amplitude_m{};

    [[nodiscard]] double rmsd_m() const noexcept TACT_RT {
        double square = 0.0;
        for (const float a : amplitude_m) square += static_cast<double>(a) * static_cast<double>(a);
        return square > 0.0 ? std::sqrt(square) : 0.0;
    }
};

class FlexibleBody {
public:
    static constexpr std::size_t kSlices = 8;
    static constexpr double kSoftness = 0.01, kRatePerS = 20.0, kSpeedMost_m_s = 10e-10, kReturnPerS = 5.0;
    static constexpr double kRmsdMost_m = 20e-10;

    // parts and levels by structure; both must outlive this object.
    FlexibleBody(const std::vector<FlexibleParts>& parts, const std::vector<std::vector<PointSet>>& levels);

    // Levels of the body in the hand: bent ones, or those of its structure if it is straight.
    [[nodiscard]] const std::vector<PointSet>& levels(std::size_t structure) const noexcept TACT_RT;
    [[nodiscard]] bool bent() const noexcept TACT_RT { return bent_; }
    [[nodiscard]] bool moved() const noexcept TACT_RT { return moved_; }  // in the last step
    // Whether a structure can bend.
    [[nodiscard]] bool can_bend(std::size_t structure) const noexcept TACT_RT {
        return parts_[structure].bends();
    }

    // The body in the hand, at the start of a step; id 0: none. Another body waits until its points are bent.
    void hold(std::uint32_t id, std::size_t structure, bool flexible) noexcept TACT_RT;
    // One slice. blend: of levels(); free: the body may bend, otherwise it keeps its shape.
    void step(const LevelBlend& blend, const Pose& T_model_body, const Budget& budget, double step_s,
              bool flexible, bool free) noexcept TACT_RT;
    // Forgets the shapes of bodies that are not in the list.
    void forget_removed(const ModelBodies& bodies) noexcept TACT_RT;
    // The shapes of another object for the same scene.
    void take_shapes(const FlexibleBody& other) noexcept TACT_RT;

    [[nodiscard]] std::span<const BodyShape> shapes() const noexcept TACT_RT { return shapes_; }
    // Largest relative change of a link's length in the body in the hand.
    [[nodiscard]] double strain() const noexcept TACT_RT { return bent_ ? strain_.strain() : 0.0; }

private:
    [[nodiscard]] BodyShape* shape_of(std::uint32_t id) noexcept;
    void shift_nodes(const FlexibleParts& parts) noexcept;
    void bend_points(const FlexibleParts& parts, std::size_t structure) noexcept;
    void end_pass(const FlexibleParts& parts) noexcept;
    void sum_forces(const LevelBlend& blend, std::size_t level, double weight,
                    const Pose& T_model_body) noexcept;
    void project_forces(const FlexibleParts& parts) noexcept;
    void move(BodyShape& shape, const FlexibleParts& parts, double bound, double step_s) noexcept;
    void straighten(BodyShape& shape, double step_s) noexcept;

    const std::vector<FlexibleParts>& parts_;
    const std::vector<std::vector<PointSet>>& levels_;
    std::vector<std::vector<PointSet>> bent_levels_;  // by structure; empty for those that do not bend
    std::array<BodyShape, ModelBodies::kMax> shapes_{};
    std::uint32_t id_ = 0;
    std::size_t structure_ = 0;
    bool bent_ = false, moved_ = false;
    std::size_t slice_ = 0, passes_ = 0;  // passes since the body came into the hand
    NodeVectors shift_;                   // of each node
    std::array<NodeVectors, 2> force_;    // on each node: of this pass, of the last one
    std::size_t now_ = 0;                 // index in force_
    NodeVectors gradient_;                // of the points of a slice
    std::array<double, kModesMax> drive_{}, next_drive_{};
    std::array<float, kModesMax> now_m_{};  // amplitudes to which the points are bent in this pass
    StrainLimit strain_;
};

}  // namespace tact
