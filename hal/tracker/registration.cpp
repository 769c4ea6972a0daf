#include "hal/tracker/registration.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <cstdio>

namespace tact {

namespace {

using Points = Eigen::Matrix3Xd;

std::string millimetres(double m) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f mm", 1e3 * m);
    return text;
}

// Root mean square of the points about their middle, along their longest and second axis.
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
               " frame: take points that are at least " + millimetres(4.0 * limits.spread_m_min) + " apart";
    if (s[1] < limits.flatness_min * s[0])
        return std::string("the points lie on a line in the ") + frame +
               " frame, about which anything may turn: take one off it";
    return {};
}

}  // namespace

Registration register_points(std::span<const PointPair> pairs, const RegistrationLimits& limits) {
    Registration result;
    if (pairs.size() < 3) {
        result.refusal = std::to_string(pairs.size()) + " pairs of points: three at least are needed";
        return result;
    }
    Points from(3, pairs.size()), to(3, pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!pairs[i].from_m.allFinite() || !pairs[i].to_m.allFinite()) {
            result.refusal = "pair " + std::to_string(i + 1) + " is not a number: take it again";
            result.worst_pair = i;
            return result;
        }
        from.col(static_cast<Eigen::Index>(i)) = pairs[i].from_m;
        to.col(static_cast<Eigen::Index>(i)) = pairs[i].to_m;
    }
    result.refusal = refuse_points(from, "first", limits);
    if (result.refusal.empty()) result.refusal = refuse_points(to, "second", limits);
    if (!result.refusal.empty()) return result;

    const Eigen::Matrix4d T = Eigen::umeyama(from, to, false);
    result.T_to_from = {T.topRightCorner<3, 1>(),
                        Quat(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized()};
    double sum = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double left = (result.T_to_from * pairs[i].from_m - pairs[i].to_m).norm();
        sum += left * left;
        if (left <= result.residual_m_max) continue;
        result.residual_m_max = left;
        result.worst_pair = i;
    }
    result.residual_m_rms = std::sqrt(sum / static_cast<double>(pairs.size()));
    if (!(result.residual_m_max <= limits.residual_m_max)) {
        result.refusal =
            "pair " + std::to_string(result.worst_pair + 1) + " is " + millimetres(result.residual_m_max) +
            " off, " + millimetres(limits.residual_m_max) +
            " are allowed: take it again, and look that points are in order and no metal is near";
        return result;
    }
    result.good = true;
    return result;
}

}  // namespace tact
