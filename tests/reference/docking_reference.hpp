// A slow and simple docking force in double precision, to judge the fast one. It shares no code with the product.
//
// Method    The values are sharpened, padded with zeros, and the equations of the cubic B-spline are solved directly, axis by
//           axis. Density, gradient and second derivatives are then sums over 4 x 4 x 4 coefficients per atom.
// Units     lengths in model metres, density in sigma, force N and torque N m at the hand, about the body's origin
// Thread    any; allocates, and takes a fifth of a microsecond per atom
//
// What the product promises, to be judged with this reference; each holds for every pose, body and scene:
//   level 1.0   |F - F_ref| <= 1e-4 |F| + 1e-4 k_E / (S v) and |Q - Q_ref| <= the same times S r, with v the smallest voxel
//               and r the body's radius: single precision of a sum of the order of its terms.
//   level < 1   |F - F_ref| <= StepResult::load.error, with F_ref of all atoms in the map of the force as it is. The error is a
//               bound that was tested over seeded poses with a margin, and that is raised once a step finds a larger one; it is no
//               proof.
//   stiffness   at rest for a tenth of a second, ModelStiffness is within 10 % of stiffness() here for the points and the map
//               of the level; at any pose and any level it is an upper bound in the same sense as the error.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace tact::reference {

struct Grid {
    std::array<int, 3> size{};
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero(), spacing_m = Eigen::Vector3d::Ones();
    std::vector<double> values;  // x fastest
    double background = 0.0, sigma = 1.0;
};

struct Atoms {
    std::vector<Eigen::Vector3d> at_m;  // body frame
    std::vector<double> weight;         // sum to 1
};

struct Place {
    Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

// At one point: density, gradient, and the matrix of second derivatives, per model metre.
struct Local {
    double density = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
};

class Spline {
public:
    explicit Spline(const Grid& grid);
    [[nodiscard]] Local at(const Eigen::Vector3d& point_m) const;

private:
    [[nodiscard]] double node(int x, int y, int z) const;

    std::array<int, 3> size_{};  // with padding
    Eigen::Vector3d origin_m_, spacing_m_;
    std::vector<double> coefficient_;
};

// Sums over the atoms, and their derivatives by position (shift) and rotation (turn) of the body.
struct Sums {
    double density = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    Eigen::Matrix3d by_shift = Eigen::Matrix3d::Zero();  // of the gradient
    Eigen::Matrix3d by_turn = Eigen::Matrix3d::Zero();   // of the moment, its symmetric part
};
Sums sum(const Spline& spline, const Atoms& atoms, const Place& body);

// k_E in joules per sigma, S in world metres per model metre.
struct Gain {
    double energy_j_per_sigma = 0.0, world_per_model = 1.0;
};
struct Wrench {
    Eigen::Vector3d force_n, torque_n_m;
};
struct Stiffness {
    double force_n_m = 0.0, torque_n_m_rad = 0.0;
};
Wrench wrench(const Sums& sums, const Gain& gain);
// Spectral norms: largest change of force per displacement of the hand, and of torque per rotation.
Stiffness stiffness(const Sums& sums, const Gain& gain);

// A map made from Gaussians, one per atom of the given height, and its exact density, gradient and second derivatives.
Local gaussians(const Atoms& atoms, const Place& body, double sigma_m, const Eigen::Vector3d& point_m);

// Climbs to a maximum of the summed density: steepest ascent with halving steps.
Place climbed(const Spline& spline, const Atoms& atoms, Place start);

}  // namespace tact::reference
