// Stiffness of the force that a tool in bone shows, from central differences of its wrench about the present pose.
//
// Turns    one axis in every second step: the three of translation, then one of rotation about the tool's origin. Each axis
//          of translation takes its turn within 8 steps, of rotation within 24, and keeps its derivative in between.
// Frame    world
// Thread   servo, TACT_RT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class DrillStiffness {
public:
    static constexpr std::uint32_t kEvery = 2;  // steps between two axes
    static constexpr double kMargin = 1.45;

    void reset() noexcept TACT_RT {
        force_n_m_.setZero();
        torque_n_m_rad_.setZero();
        largest_ = {};
    }
    // True in every kEvery-th step; axis() is then due.
    [[nodiscard]] bool due() noexcept TACT_RT { return ++steps_ % kEvery == 0; }
    // The pose, moved by h along the axis or, for an axis of rotation, turned by h / lever about it.
    [[nodiscard]] Pose moved(const Pose& pose, double h_m, double lever_m) const noexcept TACT_RT {
        Pose there = pose;
        if (turn_ % 4 < 3)
            there.p_m[turn_ % 4] += h_m;
        else
            there.q = quat_from_rotation_vector(h_m / lever_m * Vec3::Unit(turn_ / 4)) * pose.q;
        return there;
    }
    // Wrenches at moved(h) and moved(-h).
    void note(const Wrench& fore, const Wrench& back, double h_m, double lever_m) noexcept TACT_RT {
        if (turn_ % 4 < 3)
            force_n_m_.col(turn_ % 4) = (fore.force_n - back.force_n) / (2.0 * h_m);
        else
            torque_n_m_rad_.col(turn_ / 4) = (fore.torque_n_m - back.torque_n_m) * lever_m / (2.0 * h_m);
        turn_ = (turn_ + 1) % 12;
        largest_ = {.force_n_m = kMargin * norm(force_n_m_),
                    .torque_n_m_rad = kMargin * norm(torque_n_m_rad_)};
    }
    // With a margin for the error of coarse blocks.
    [[nodiscard]] const ModelStiffness& largest() const noexcept TACT_RT { return largest_; }

private:
    // Largest singular value.
    [[nodiscard]] static double norm(const Eigen::Matrix3d& m) noexcept TACT_RT {
        const Eigen::Matrix3d square = m.transpose() * m;
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
        solver.computeDirect(square, Eigen::EigenvaluesOnly);
        return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
    }

    Eigen::Matrix3d force_n_m_ = Eigen::Matrix3d::Zero(), torque_n_m_rad_ = Eigen::Matrix3d::Zero();
    ModelStiffness largest_;
    int turn_ = 0;
    std::uint32_t steps_ = 0;
};

}  // namespace tact
