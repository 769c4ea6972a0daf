// A rigid motion of the atoms of a file, in ångström.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "ipc/base/pose.hpp"
#include "ipc/base/units.hpp"

namespace tact {

// Anisotropic displacement parameters in the order of both formats: U11 U22 U33 U12 U13 U23.
using Adp = std::array<double, 6>;

struct AtomMove {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Vec3 shift_a = Vec3::Zero();

    // The motion from the coordinates in the file to the pose of the body.
    static AtomMove of(const Pose& T_model_body, const Vec3& home_com_model_m) {
        AtomMove move;
        move.turn = T_model_body.q.normalized().toRotationMatrix();
        move.shift_a = (T_model_body.p_m - move.turn * home_com_model_m) / kAngstromM;
        return move;
    }
    [[nodiscard]] Vec3 operator*(const Vec3& place_a) const { return turn * place_a + shift_a; }
    // U' = R U R^T. Also valid for B and beta in Cartesian axes, which are proportional to U.
    [[nodiscard]] Adp turned(const Adp& u) const {
        Eigen::Matrix3d m;
        m << u[0], u[3], u[4], u[3], u[1], u[5], u[4], u[5], u[2];
        m = turn * m * turn.transpose();
        return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    }
};

}  // namespace tact
