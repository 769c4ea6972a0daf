// Stiffness of the force that a tool in bone shows, from central differences of its wrench about the present pose.
//
// Turns    two steps an axis, one evaluation of the wrench in each, about the pose of the first: the three of translation,
//          then one of rotation about the tool's origin. Each axis of translation takes its turn within 8 steps, of
//          rotation within 24, and keeps its derivative in between.
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
    static constexpr double kMargin = 1.45;

    void reset() noexcept TACT_RT {
        force_n_m_.setZero();
        torque_n_m_rad_.setZero();
        largest_ = {};
        back_ = false;
    }
    // The pose at which the wrench is needed now, for a tool at `pose`: moved by h along the axis or, for an axis of
    // rotation, turned by h / lever about it; in every second call back by as much from the pose of the call before.
    [[nodiscard]] Pose next(const Pose& pose, double h_m, double lever_m) noexcept TACT_RT {
        if (!back_) about_ = pose;
        const double way_m = back_ ? -h_m : h_m;
        Pose there = about_;
        if (turn_ % 4 < 3)
            there.p_m[turn_ % 4] += way_m;
        else
            there.q = quat_from_rotation_vector(way_m / lever_m * Vec3::Unit(turn_ / 4)) * about_.q;
        return there;
    }
    // The wrench at the pose that next() returned.
    void note(const Wrench& wrench, double h_m, double lever_m) noexcept TACT_RT {
        back_ = !back_;
        if (back_) {
            fore_ = wrench;
            return;
        }
        if (turn_ % 4 < 3)
            force_n_m_.col(turn_ % 4) = (fore_.force_n - wrench.force_n) / (2.0 * h_m);
        else
            torque_n_m_rad_.col(turn_ / 4) = (fore_.torque_n_m - wrench.torque_n_m) * lever_m / (2.0 * h_m);
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
    bool back_ = false;  // the evaluation at the far side is done
    Pose about_;
    Wrench fore_;
};

}  // namespace tact
