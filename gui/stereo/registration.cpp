// Pointer tip: p_i + q_i t = c for every pose i, linear in the tip t and its fixed point c. The smallest singular
// value of that system, over the square root of its number of rows, is the sine of half the rotation about the least
// rotated axis. With rotation about one axis alone, the tip may be anywhere along it, and the value is zero.
#include "gui/stereo/registration.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <cstdio>

namespace tact {

namespace {

using Points = Eigen::Matrix3Xd;

constexpr double kOutlierM = 3e-3, kOutlierTimes = 3.0;
constexpr std::size_t kPivotPosesMin = 30, kPivotPosesMax = 2000;
constexpr double kPivotTurnMin = 0.08;
constexpr double kPivotRmsM = 5e-3;

std::string millimetres(double m) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f mm", 1e3 * m);
    return text;
}

// Root mean square of the points about their mean, along their longest and second axis.
Eigen::Vector2d spreads_m(const Points& points) {
    const Points centred = points.colwise() - points.rowwise().mean();
    const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(points.cols());
    const Vec3 s = covariance.jacobiSvd().singularValues();
    return {std::sqrt(s[0]), std::sqrt(s[1])};
}

std::string refuse_points(const Points& points, const char* frame, const RegistrationLimits& limits) {
    const Eigen::Vector2d s = spreads_m(points);
    if (s[0] < limits.spread_m_min)
        return std::string("the points lie within ") + millimetres(s[0]) + " of each other in the " + frame +
               " frame: choose points at least " + millimetres(4.0 * limits.spread_m_min) + " apart";
    if (s[1] < limits.flatness_min * s[0])
        return std::string("the points lie on a line in the ") + frame +
               " frame, so rotation about it is unknown: add a point off the line";
    return {};
}

struct Fit {
    Pose T;
    std::vector<double> residual_m;
    double rms_m = 0.0, worst_m = 0.0;
    std::size_t worst = 0;
};

Fit fit_rigid(const Points& from, const Points& to) {
    Fit fit;
    const Eigen::Matrix4d T = Eigen::umeyama(from, to, false);
    fit.T = {T.topRightCorner<3, 1>(), Quat(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized()};
    double sum = 0.0;
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
        const double left = (fit.T * Vec3(from.col(i)) - to.col(i)).norm();
        fit.residual_m.push_back(left);
        sum += left * left;
        if (left <= fit.worst_m) continue;
        fit.worst_m = left;
        fit.worst = static_cast<std::size_t>(i);
    }
    fit.rms_m = std::sqrt(sum / static_cast<double>(from.cols()));
    return fit;
}

double stretch_of(const Points& from, const Points& to, const Pose& T) {
    const Points f = from.colwise() - from.rowwise().mean(), t = to.colwise() - to.rowwise().mean();
    return (T.q.toRotationMatrix() * f).cwiseProduct(t).sum() / f.squaredNorm();
}

Points without(const Points& points, Eigen::Index i) {
    Points rest(3, points.cols() - 1);
    rest << points.leftCols(i), points.rightCols(points.cols() - 1 - i);
    return rest;
}

// Leaves each pair out, so that it does not distort the fit of the others. Three others fit too easily to decide.
std::optional<std::size_t> outlier_of(const Points& from, const Points& to,
                                      const RegistrationLimits& limits) {
    std::optional<std::size_t> found;
    double most = 0.0;
    for (Eigen::Index i = 0; from.cols() >= 5 && i < from.cols(); ++i) {
        const Points f = without(from, i), t = without(to, i);
        if (!refuse_points(f, "", limits).empty() || !refuse_points(t, "", limits).empty()) continue;
        const Fit others = fit_rigid(f, t);
        const double off = (others.T * Vec3(from.col(i)) - to.col(i)).norm();
        if (off < kOutlierM || off < kOutlierTimes * others.worst_m || off <= most) continue;
        most = off;
        found = static_cast<std::size_t>(i);
    }
    return found;
}

}  // namespace

FitGrade fit_grade(double rms_m, double worst_m) {
    if (rms_m <= kGreenRmsM && worst_m <= kGreenWorstM) return FitGrade::green;
    return rms_m <= kAmberRmsM && worst_m <= kAmberWorstM ? FitGrade::amber : FitGrade::red;
}

const char* fit_grade_text(FitGrade grade) {
    static constexpr const char* kWords[] = {"not measured", "green", "amber", "red"};
    return kWords[static_cast<std::size_t>(grade)];
}

Registration register_points(std::span<const PointPair> pairs, const RegistrationLimits& limits) {
    Registration result;
    if (pairs.size() < 3) {
        result.refusal = std::to_string(pairs.size()) + " pairs of points: at least three are needed";
        return result;
    }
    Points from(3, pairs.size()), to(3, pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!pairs[i].from_m.allFinite() || !pairs[i].to_m.allFinite()) {
            result.refusal = "pair " + std::to_string(i + 1) + " is not a number: measure it again";
            result.worst_pair = i;
            return result;
        }
        from.col(static_cast<Eigen::Index>(i)) = pairs[i].from_m;
        to.col(static_cast<Eigen::Index>(i)) = pairs[i].to_m;
    }
    result.refusal = refuse_points(from, "first", limits);
    if (result.refusal.empty()) result.refusal = refuse_points(to, "second", limits);
    if (!result.refusal.empty()) return result;

    Fit fit = fit_rigid(from, to);
    result.T_to_from = fit.T;
    result.residual_m = std::move(fit.residual_m);
    result.residual_m_rms = fit.rms_m;
    result.residual_m_max = fit.worst_m;
    result.worst_pair = fit.worst;
    result.stretch = stretch_of(from, to, fit.T);
    result.outlier = outlier_of(from, to, limits);
    if (!(fit.worst_m <= limits.residual_m_max && fit.rms_m <= limits.residual_m_rms)) {
        const std::size_t again = result.outlier.value_or(result.worst_pair);
        result.refusal = "pair " + std::to_string(again + 1) + " is " +
                         millimetres(result.residual_m[again]) + " off (" + millimetres(fit.rms_m) +
                         " rms): " + millimetres(limits.residual_m_max) + " and " +
                         millimetres(limits.residual_m_rms) +
                         " are allowed: measure it again; check the order of the points and metal nearby";
        return result;
    }
    result.good = true;
    return result;
}

PivotFit fit_pivot(std::span<const Pose> T_frame_sensor) {
    PivotFit result;
    const std::size_t every = T_frame_sensor.size() / kPivotPosesMax + 1;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < T_frame_sensor.size(); i += every)
        if (T_frame_sensor[i].finite()) poses.push_back(T_frame_sensor[i]);
    if (poses.size() < kPivotPosesMin) {
        result.refusal = std::to_string(poses.size()) + " poses were received, " +
                         std::to_string(kPivotPosesMin) +
                         " are needed: keep the sensor in the tracker's range";
        return result;
    }
    const auto rows = static_cast<Eigen::Index>(3 * poses.size());
    Eigen::MatrixXd a(rows, 6);
    Eigen::VectorXd b(rows);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(3 * i);
        a.block<3, 3>(row, 0) = poses[i].q.normalized().toRotationMatrix();
        a.block<3, 3>(row, 3) = -Eigen::Matrix3d::Identity();
        b.segment<3>(row) = -poses[i].p_m;
    }
    // 6 x 6: equally accurate here, and its size does not grow with the poses.
    const Eigen::Matrix<double, 6, 6> normal = a.transpose() * a / static_cast<double>(poses.size());
    const Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(normal,
                                                            Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (!(std::sqrt(svd.singularValues()[5]) >= kPivotTurnMin)) {
        result.refusal =
            "the pointer was tilted too little: tilt it by at least 20 degrees forwards, backwards and to "
            "both sides";
        return result;
    }
    const Eigen::Matrix<double, 6, 1> x = svd.solve(a.transpose() * b / static_cast<double>(poses.size()));
    result.tip_sensor_m = x.head<3>();
    result.residual_m_rms = std::sqrt((a * x - b).squaredNorm() / static_cast<double>(poses.size()));
    result.good = result.residual_m_rms <= kPivotRmsM;
    if (!result.good)
        result.refusal = "the tip moved by " + millimetres(result.residual_m_rms) + " (" +
                         millimetres(kPivotRmsM) + " allowed): hold it in a hollow while tilting";
    return result;
}

}  // namespace tact
