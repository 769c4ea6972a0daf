#include "prep/search/symmetry.hpp"

#include <Eigen/Cholesky>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr unsigned kOrderMax = 60;
constexpr int kSteps = 60;

Pose about_z(double angle_rad, double along_m = 0.0) {
    return {Vec3(0.0, 0.0, along_m), Quat(Eigen::AngleAxisd(angle_rad, Vec3::UnitZ()))};
}

// A motion as a turn about an axis and a move along it.
struct Screw {
    Vec3 axis, through_m;  // a point of the axis
    double angle_rad = 0.0, along_m = 0.0;
};

Screw screw_of(const Pose& motion) {
    const Vec3 turn = rotation_vector_rad(motion.q);
    Screw s;
    s.angle_rad = turn.norm();
    if (s.angle_rad < 1e-6) {  // a plain move: the axis is along it, anywhere
        s.along_m = motion.p_m.norm();
        s.axis = s.along_m > 0.0 ? Vec3(motion.p_m / s.along_m) : Vec3(Vec3::UnitZ());
        s.through_m.setZero();
        return s;
    }
    s.axis = turn / s.angle_rad;
    s.along_m = motion.p_m.dot(s.axis);
    const Vec3 across = motion.p_m - s.along_m * s.axis;
    s.through_m = 0.5 * (across + s.axis.cross(across) / std::tan(0.5 * s.angle_rad));
    return s;
}

Pose frame_on(const Vec3& axis, const Vec3& through_m) {
    return {through_m, Quat::FromTwoVectors(Vec3::UnitZ(), axis)};
}

// The distance of two angles, the shorter way round.
double between_rad(double a, double b) { return std::abs(std::remainder(a - b, kTurn)); }

bool number(const std::string& text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

[[noreturn]] void refuse(const std::string& name) {
    throw StartupError("symmetry '" + name + "'", "it is none that is known",
                       "give C2 to C60, D2 to D60, helix:RISE,TWIST,COPIES with angstrom and degrees, e.g. "
                       "helix:27.5,-166.6,7, or find");
}

Symmetry helix_of(const std::string& name) {
    std::vector<double> values;
    std::size_t at = name.find(':');
    while (at != std::string::npos) {
        const std::size_t end = name.find(',', at + 1);
        double value = 0.0;
        if (!number(name.substr(at + 1, end == std::string::npos ? end : end - at - 1), value)) refuse(name);
        values.push_back(value);
        at = end;
    }
    if (values.size() != 3 || !(values[2] >= 2.0 && values[2] <= kOrderMax) ||
        values[2] != std::floor(values[2]))
        refuse(name);
    if (!(std::abs(values[0]) > 0.0) || std::abs(values[0]) > 1e4 || std::abs(values[1]) > 360.0)
        refuse(name);
    return {Symmetry::Kind::helical, static_cast<unsigned>(values[2]), values[0] * kAngstromM,
            values[1] * kDegreeRad};
}

using Vec12 = Eigen::Matrix<double, 12, 1>;

Pose moved(const Pose& pose, const Eigen::Ref<const Eigen::Matrix<double, 6, 1>>& by, double gyration_m) {
    const Vec3 turn_rad = by.tail<3>() / gyration_m;
    return {pose.p_m + by.head<3>(), (quat_from_rotation_vector(turn_rad) * pose.q).normalized()};
}

SymmetricPlace moved(const SymmetricPlace& place, const Vec12& by, double gyration_m) {
    return {moved(place.T_model_frame, by.head<6>(), gyration_m),
            moved(place.T_model_first, by.tail<6>(), gyration_m)};
}

Eigen::VectorXd misfit(const Symmetry& symmetry, std::span<const Pose> copies, const SymmetricPlace& place,
                       double gyration_m) {
    Eigen::VectorXd out(static_cast<Eigen::Index>(6 * copies.size()));
    for (std::size_t k = 0; k < copies.size(); ++k) {
        const Pose at = pose_of_copy(symmetry, place, k);
        const auto row = static_cast<Eigen::Index>(6 * k);
        out.segment<3>(row) = at.p_m - copies[k].p_m;
        out.segment<3>(row + 3) = gyration_m * rotation_vector_rad(at.q * copies[k].q.conjugate());
    }
    return out;
}

}  // namespace

Pose Symmetry::element(std::size_t k) const {
    if (kind == Kind::helical)
        return about_z(static_cast<double>(k) * twist_rad, static_cast<double>(k) * rise_m);
    const Pose turn = about_z(kTurn * static_cast<double>(k % order) / order);
    return k < order ? turn : turn * Pose{Vec3::Zero(), Quat(0.0, 1.0, 0.0, 0.0)};
}

std::string Symmetry::name() const {
    if (kind == Kind::cyclic) return "C" + std::to_string(order);
    if (kind == Kind::dihedral) return "D" + std::to_string(order);
    char text[80];
    std::snprintf(text, sizeof text, "helix:%g,%g,%u", rise_m / kAngstromM, twist_rad / kDegreeRad, order);
    return text;
}

Symmetry symmetry_of(const std::string& name) {
    if (name.rfind("helix:", 0) == 0) return helix_of(name);
    double order = 0.0;
    const char kind = name.empty() ? ' ' : name.front();
    if ((kind != 'C' && kind != 'D') || !number(name.substr(1), order) || order != std::floor(order) ||
        !(order >= 2.0 && order <= kOrderMax))
        refuse(name);
    return {kind == 'C' ? Symmetry::Kind::cyclic : Symmetry::Kind::dihedral, static_cast<unsigned>(order),
            0.0, 0.0};
}

std::vector<Symmetry> symmetries_of(const std::string& name) {
    if (name != "find") return {symmetry_of(name)};
    std::vector<Symmetry> list;
    for (unsigned n = 2; n <= 12; ++n) list.push_back({Symmetry::Kind::cyclic, n});
    for (unsigned n = 2; n <= 7; ++n) list.push_back({Symmetry::Kind::dihedral, n});
    return list;
}

Pose pose_of_copy(const Symmetry& symmetry, const SymmetricPlace& place, std::size_t k) {
    return place.T_model_frame * symmetry.element(k) * place.T_model_frame.inverse() * place.T_model_first;
}

SymmetricPlace nearest_symmetric(const Symmetry& symmetry, std::span<const Pose> copies,
                                 const SymmetricPlace& start, double gyration_m) {
    constexpr double kDifference = 1e-6;  // of the gyration radius
    SymmetricPlace place = start;
    Eigen::VectorXd now = misfit(symmetry, copies, place, gyration_m);
    double damping = 1e-3;
    for (int step = 0; step < kSteps; ++step) {
        Eigen::MatrixXd slope(now.size(), 12);
        for (Eigen::Index i = 0; i < 12; ++i) {
            Vec12 by = Vec12::Zero();
            by[i] = kDifference * gyration_m;
            slope.col(i) = (misfit(symmetry, copies, moved(place, by, gyration_m), gyration_m) - now) / by[i];
        }
        Eigen::Matrix<double, 12, 12> normal = slope.transpose() * slope;
        normal.diagonal().array() +=
            damping;  // the place along the axis of C, and turns about it, change nothing
        const Vec12 by = normal.ldlt().solve(-(slope.transpose() * now));
        const SymmetricPlace next = moved(place, by, gyration_m);
        const Eigen::VectorXd then = misfit(symmetry, copies, next, gyration_m);
        if (!(then.squaredNorm() < now.squaredNorm())) {
            damping *= 10.0;
            if (damping > 1e6) break;
            continue;
        }
        const bool small = now.squaredNorm() - then.squaredNorm() < 1e-12 * now.squaredNorm();
        place = next, now = then, damping = std::max(0.1 * damping, 1e-9);
        if (small) break;
    }
    return place;
}

std::vector<Pose> frames_from_pair(const Symmetry& symmetry, const Pose& from, const Pose& to,
                                   double tolerance_m, double tolerance_rad) {
    const Screw screw = screw_of(to * from.inverse());
    std::vector<Pose> frames;
    // The axis may point either way; the angle and the move along it change their signs with it.
    for (const double way : {1.0, -1.0}) {
        const double angle_rad = way * screw.angle_rad, along_m = way * screw.along_m;
        for (unsigned k = 1; k < symmetry.order; ++k) {
            const bool helix = symmetry.kind == Symmetry::Kind::helical;
            const double wanted_rad = helix ? k * symmetry.twist_rad : kTurn * k / symmetry.order;
            const double wanted_m = helix ? k * symmetry.rise_m : 0.0;
            if (between_rad(angle_rad, wanted_rad) > tolerance_rad ||
                std::abs(along_m - wanted_m) > tolerance_m)
                continue;
            frames.push_back(frame_on(way * screw.axis, screw.through_m));
            if (!helix) return frames;  // the elements of C and D are the same for either way
            break;
        }
    }
    return frames;
}

bool across(Pose& T_model_frame, const Pose& from, const Pose& to, double tolerance_m, double tolerance_rad) {
    const Screw screw = screw_of(to * from.inverse());
    const Vec3 z = T_model_frame.q * Vec3::UnitZ();
    if (std::abs(screw.angle_rad - std::numbers::pi) > tolerance_rad || std::abs(screw.along_m) > tolerance_m)
        return false;
    if (std::abs(screw.axis.dot(z)) > std::sin(tolerance_rad)) return false;
    const Vec3 x = (screw.axis - screw.axis.dot(z) * z).normalized(), y = z.cross(x);
    // The two axes must meet; z is where they pass each other.
    const Vec3 offset_m = screw.through_m - T_model_frame.p_m;
    if (std::abs(offset_m.dot(y)) > tolerance_m) return false;
    Eigen::Matrix3d axes;
    axes << x, y, z;
    T_model_frame = {T_model_frame.p_m + offset_m.dot(z) * z, Quat(axes)};
    return true;
}

}  // namespace tact
