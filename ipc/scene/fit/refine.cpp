// Coordinates. A step x = (shift s, turn t) maps the pose (c, q) to (c + s, exp(D^-1 t) q), where D is the
// square root of the inertia tensor per mass, about c in model axes, kept at its initial value. Then the
// mean square displacement of the atoms is |s|^2 + |t|^2 to first order, for structures of any shape, and
// the ascent is steepest per ångström of atom displacement. The gradient of the score in these coordinates
// is (F, D^-1 Q), with F and Q as in the force model: F = d score / d c, Q = d score / d rotation.
//
// Search. Direction H g, with H initially the identity: plain steepest ascent. The first length is a
// quarter of the largest step; then 1, as in Newton's method, limited to the largest step. A step is
// accepted when the score rises by 1e-4 of the linear prediction, or, within rounding errors (sums are in
// single precision), when it does not fall and the slope does; otherwise the step is shortened, to the
// maximum of the parabola through the known values, within [1/10, 1/2]. After a step H is updated (BFGS,
// Nocedal & Wright 6.17) where the curvature is that of a maximum. If H g yields no step, H is reset to the
// identity; if that yields none either, this is the maximum.
#include "ipc/scene/fit/refine.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/simulated_map.hpp"

namespace tact {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kRise = 1e-4;      // fraction of the linear prediction
constexpr double kRounding = 2e-6;  // relative to the score
constexpr int kShorteningsMax = 20;
constexpr double kShareShown = 0.05;  // fraction of the simulated maximum: region of the correlations
constexpr double kPointsPerResolution = 3.0;
constexpr std::size_t kPointsMax = 400'000;  // in the box around the structure

struct Slope {
    double score = 0.0;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

// With their simulated density.
CorrelationPoints simulated_points(const Structure& s, double resolution_m) {
    DensityGrid grid;
    Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                     static_cast<double>(s.z_m[i]));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double margin_m = kSimulatedCutSigmas * kSigmaPerResolution * resolution_m;
    double step_m = resolution_m / kPointsPerResolution;
    const Vec3 wide_m = high - low + Vec3::Constant(2.0 * margin_m);
    while ((wide_m / step_m).array().ceil().prod() > static_cast<double>(kPointsMax)) step_m *= 1.25;
    grid.origin_m = low - Vec3::Constant(margin_m);
    grid.spacing_m = Vec3::Constant(step_m);
    for (int a = 0; a < 3; ++a)
        grid.size[static_cast<std::size_t>(a)] =
            static_cast<std::uint32_t>(std::ceil(wide_m[a] / step_m)) + 1;
    const PlacedStructure placed{&s, Pose{}};
    const std::vector<float> map = simulated_map(grid, {&placed, 1}, resolution_m);
    const auto least = static_cast<float>(kShareShown) * *std::max_element(map.begin(), map.end());
    CorrelationPoints points;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++i) {
                if (!(map[i] > least)) continue;
                points.at_m.emplace_back(grid.origin_m + step_m * Vec3(x, y, z));
                points.value.push_back(static_cast<double>(map[i]));
            }
        }
    }
    return points;
}

class Score {
public:
    Score(const DensityMap& map, const Structure& s, const RefineSettings& settings)
        : map_(map), structure_(s), settings_(settings) {
        if (settings.goal == RefineGoal::mean_density || settings.points != nullptr) return;
        simulated_ = simulated_points(s, settings.resolution_m);
    }

    [[nodiscard]] Slope at(const Pose& pose) const {
        if (settings_.goal != RefineGoal::mean_density) return correlation(pose);
        const DensitySums sums =
            map_.sum({structure_.x_m, structure_.y_m, structure_.z_m, structure_.mass_fraction}, pose);
        return {sums.density_sigma, sums.gradient, sums.moment};
    }

private:
    // With u fixed and v the map at the points: C = sum u' v' / (|u'| |v'|), u' = u - mean or u, v'
    // likewise. dC = sum (u' / (|u'| |v'|) - C v' / |v'|^2) dv; for deviations from the mean, the factor
    // sums to zero, so that the mean of dv cancels.
    [[nodiscard]] Slope correlation(const Pose& pose) const {
        const CorrelationPoints& points = settings_.points != nullptr ? *settings_.points : simulated_;
        const std::size_t n = points.at_m.size();
        std::vector<double> v(n);
        std::vector<Vec3> gradient(n), arm(n);
        const Eigen::Matrix3d turn = pose.q.toRotationMatrix();
        double mean_u = 0.0, mean_v = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            arm[i] = turn * points.at_m[i];
            v[i] = map_.sample(pose.p_m + arm[i], gradient[i]) + settings_.background_sigma;
            mean_u += points.value[i];
            mean_v += v[i];
        }
        const bool about_mean = settings_.goal == RefineGoal::correlation_mean;
        mean_u = about_mean ? mean_u / static_cast<double>(n) : 0.0;
        mean_v = about_mean ? mean_v / static_cast<double>(n) : 0.0;
        double uu = 0.0, vv = 0.0, uv = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double a = points.value[i] - mean_u, b = v[i] - mean_v;
            uu += a * a, vv += b * b, uv += a * b;
        }
        Slope slope;
        if (!(uu > 0.0) || !(vv > 0.0)) return slope;
        const double both = std::sqrt(uu * vv);
        slope.score = uv / both;
        for (std::size_t i = 0; i < n; ++i) {
            const double share = (points.value[i] - mean_u) / both - slope.score * (v[i] - mean_v) / vv;
            slope.force += share * gradient[i];
            slope.torque += share * arm[i].cross(gradient[i]);
        }
        return slope;
    }

    const DensityMap& map_;
    const Structure& structure_;
    const RefineSettings& settings_;
    CorrelationPoints simulated_;
};

// Inverse of the square root of the inertia tensor per mass, model axes. Directions in which a rotation
// moves hardly any atom (a rod about its axis) count as one hundredth of the largest.
Eigen::Matrix3d turn_per_length(const Structure& s, const Quat& q) {
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                     static_cast<double>(s.z_m[i]));
        inertia += static_cast<double>(s.mass_fraction[i]) *
                   (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
    const double most = std::max(axes.eigenvalues().maxCoeff(), 1e-2 * kAngstromM * kAngstromM);
    const Vec3 root = axes.eigenvalues().cwiseMax(1e-4 * most).cwiseSqrt();
    const Eigen::Matrix3d to_model = q.toRotationMatrix() * axes.eigenvectors();
    return to_model * root.cwiseInverse().asDiagonal() * to_model.transpose();
}

class Ascent {
public:
    Ascent(const Score& score, const Structure& s, const Pose& start, const RefineSettings& settings)
        : score_(score), settings_(settings), turn_(turn_per_length(s, start.q)), pose_(start) {
        look(score_.at(pose_));
    }

    [[nodiscard]] bool flat() const { return !(gradient_.norm() > 0.0) || !gradient_.allFinite(); }
    [[nodiscard]] double score() const { return now_; }
    [[nodiscard]] const Pose& pose() const { return pose_; }

    // One uphill step; false at the maximum.
    bool step() {
        for (const bool plain : {false, true}) {
            if (plain || !(gradient_.dot(metric_ * gradient_) > 0.0)) reset();
            Vec6 ahead = metric_ * gradient_;
            double length = ahead.norm();
            if (fresh_) length = 0.25 * settings_.step_m_max;
            length = std::min(length, settings_.step_m_max);
            ahead.normalize();
            if (search(ahead, length)) return true;
            if (fresh_) return false;
        }
        return false;
    }

private:
    void look(const Slope& slope) {
        now_ = slope.score;
        gradient_ << slope.force, turn_.transpose() * slope.torque;
    }
    void reset() {
        metric_.setIdentity();
        fresh_ = true;
    }
    [[nodiscard]] Pose moved(const Vec6& x) const {
        return {pose_.p_m + x.head<3>(),
                (quat_from_rotation_vector(turn_ * x.tail<3>()) * pose_.q).normalized()};
    }
    // True if a step in these coordinates is above the stop limits.
    [[nodiscard]] bool seen(const Vec6& x) const {
        return x.head<3>().norm() >= settings_.stop_m || (turn_ * x.tail<3>()).norm() >= settings_.stop_rad;
    }

    bool search(const Vec6& ahead, double length) {
        const double rise = gradient_.dot(ahead);
        for (int i = 0; i < kShorteningsMax; ++i) {
            const Vec6 x = length * ahead;
            if (!seen(x)) return false;
            const Pose there = moved(x);
            const Slope slope = score_.at(there);
            Vec6 gradient;
            gradient << slope.force, turn_.transpose() * slope.torque;
            const double gain = slope.score - now_;
            const bool enough = gain >= kRise * length * rise;
            const bool even =
                std::abs(gain) <= kRounding * std::abs(now_) && std::abs(gradient.dot(ahead)) < 0.9 * rise;
            if (std::isfinite(slope.score) && gradient.allFinite() && (enough || even)) {
                learn(x, gradient);
                pose_ = there;
                now_ = slope.score;
                gradient_ = gradient;
                return true;
            }
            // Maximum of the parabola with this slope here and that score there.
            const double bend = length * rise - gain;
            const double top = bend > 0.0 ? 0.5 * length * length * rise / bend : 0.5 * length;
            length = std::isfinite(top) ? std::clamp(top, 0.1 * length, 0.5 * length) : 0.1 * length;
        }
        return false;
    }

    void learn(const Vec6& x, const Vec6& gradient) {
        const Vec6 fall = gradient_ - gradient;  // decrease of the gradient: positive along x near a maximum
        const double bend = x.dot(fall);
        if (!(bend > 1e-10 * x.norm() * fall.norm())) return;  // the curvature of a minimum is not usable
        if (fresh_) metric_ = Mat6::Identity() * (bend / fall.squaredNorm());
        const Mat6 left = Mat6::Identity() - x * fall.transpose() / bend;
        metric_ = left * metric_ * left.transpose() + x * x.transpose() / bend;
        fresh_ = false;
    }

    const Score& score_;
    const RefineSettings& settings_;
    const Eigen::Matrix3d turn_;
    Pose pose_;
    double now_ = 0.0;
    Vec6 gradient_ = Vec6::Zero();
    Mat6 metric_ = Mat6::Identity();
    bool fresh_ = true;  // metric_ has no update yet
};

}  // namespace

RefineResult refine(const DensityMap& map, const Structure& structure, const Pose& start,
                    const RefineSettings& wanted, const RefineProgress& progress) {
    const std::string attempt = "refining the pose of " + structure.name;
    RefineSettings settings = wanted;
    if (!start.finite() || !(std::abs(start.q.norm() - 1.0) < 1e-3) || structure.size() == 0)
        throw StartupError(attempt, "its present pose is invalid", "place the structure first");
    if (settings.goal != RefineGoal::mean_density && settings.points == nullptr &&
        (!(settings.resolution_m > 0.0) || !std::isfinite(settings.resolution_m)))
        throw StartupError(attempt, "the resolution of the map is unknown", "set it with --resolution-a");
    if (!(settings.step_m_max > 0.0)) settings.step_m_max = 0.5 * map.spacing_m().minCoeff();
    const Score score(map, structure, settings);
    Ascent ascent(score, structure, {start.p_m, start.q.normalized()}, settings);
    RefineResult result;
    result.T_model_body = start;
    result.score = result.score_start = ascent.score();
    if (ascent.flat()) return result;
    result.end = RefineEnd::iterations;
    for (; result.iterations < settings.iterations_max; ++result.iterations) {
        if (progress && !progress(result.iterations, ascent.score())) {
            result.end = RefineEnd::cancelled;
            break;
        }
        if (!ascent.step()) {
            result.end = RefineEnd::converged;
            break;
        }
    }
    if (ascent.score() >= result.score_start) {
        result.T_model_body = ascent.pose();
        result.score = ascent.score();
    }
    return result;
}

}  // namespace tact
