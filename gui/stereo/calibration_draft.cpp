// Updates the draft with fits of measurements and with typed values, within the ranges of a stage file.
#include <Eigen/QR>
#include <algorithm>
#include <utility>

#include "gui/stereo/calibration.hpp"

namespace tact {
namespace {

constexpr double kEyesApartMostM = 0.2, kMiddleMostM = 0.5, kTipMostM = 1.0;

// The ranges of a stage file.
bool within(const Vec3& v, double most) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

ScreenPlace of_frame(const Pose& T_screen_glass, double width_m, double height_m) {
    const ScreenPlace flat = ScreenPlace::of_size(width_m, height_m);
    return {T_screen_glass * flat.lower_left_m, T_screen_glass * flat.lower_right_m,
            T_screen_glass * flat.upper_left_m};
}

// Size of the display from the marks alone: the plane that fits them best, with free scale along both axes.
Eigen::Vector2d size_by_marks(const Calibration::Marks& marks) {
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < kMarks; ++i)
        if (marks.mark[i].taken && marks.outlier() != i) taken.push_back(i);
    if (taken.size() < kMarksMin) return Eigen::Vector2d::Zero();
    Eigen::MatrixXd a(static_cast<Eigen::Index>(taken.size()), 3),
        b(static_cast<Eigen::Index>(taken.size()), 3);
    for (std::size_t k = 0; k < taken.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        a.row(row) << 1.0, kMarkPlaces[taken[k]][0], kMarkPlaces[taken[k]][1];
        b.row(row) = marks.mark[taken[k]].to_m.transpose();
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
    if (qr.rank() < 3) return Eigen::Vector2d::Zero();
    const Eigen::MatrixXd x = qr.solve(b);
    return {x.row(1).norm(), x.row(2).norm()};
}

}  // namespace

std::size_t Calibration::Marks::taken() const {
    return static_cast<std::size_t>(
        std::count_if(mark.begin(), mark.end(), [](const Mark& m) { return m.taken; }));
}

std::optional<double> Calibration::Marks::residual_m(std::size_t of_mark) const {
    for (std::size_t i = 0; i < std::min(of_fit.size(), fit.residual_m.size()); ++i)
        if (of_fit[i] == of_mark) return fit.residual_m[i];
    return std::nullopt;
}

std::optional<std::size_t> Calibration::Marks::outlier() const {
    if (!fit.outlier || *fit.outlier >= of_fit.size()) return std::nullopt;
    return of_fit[*fit.outlier];
}

void Calibration::follow_turning() {
    if (input_.sensor_good && input_.sensor_at_ns != turned_at_ns_) {
        turned_at_ns_ = input_.sensor_at_ns;
        turned_.push_back(input_.T_screen_sensor);
    }
    if (input_.now_s - turning_from_s_ < kTurningS) return;
    turning_ = false;
    pivot_ = fit_pivot(turned_);
    if (!pivot_->good) {
        say("Not accepted: " + pivot_->refusal + ".");
    } else if (!within(pivot_->tip_sensor_m, kTipMostM)) {
        pivot_->good = false;
        say("Not accepted: the tip would be over a metre from the sensor. Tilt farther, about one point.");
    } else {
        draft_.wand_tip_sensor_m = pivot_->tip_sensor_m;
        say("The tip is measured.");
    }
}

void Calibration::fit() {
    Marks& marks = own_marks();
    std::vector<PointPair> pairs;
    marks.of_fit.clear();
    for (std::size_t i = 0; i < kMarks; ++i) {
        const Mark& m = marks.mark[i];
        if (!m.taken) continue;
        // On the glass, in its current size.
        pairs.push_back({step_ == CalibrationStep::workspace ? m.from_m : glass_m(i), m.to_m});
        marks.of_fit.push_back(i);
    }
    marks.fit = {};
    if (&marks == &screen_) measured_size_m_ = Eigen::Vector2d::Zero();
    if (pairs.size() < kMarksMin) return;
    marks.fit = register_points(pairs);
    if (&marks == &screen_) measured_size_m_ = size_by_marks(marks);
    if (!marks.fit.good) return;
    if (step_ == CalibrationStep::workspace) {
        if (!within(marks.fit.T_to_from.p_m, 10.0)) return;
        draft_.T_screen_world = marks.fit.T_to_from;
        draft_.in_workspace = true;
    } else {
        draft_.screen = of_frame(marks.fit.T_to_from, draft_.screen.width_m(), draft_.screen.height_m());
        draft_.screen_measured = true;
        typed_screen_ = false;
    }
}

void Calibration::set_picture_size(double width_m, double height_m) {
    if (!(width_m >= 0.01 && width_m <= 100.0 && height_m >= 0.01 && height_m <= 100.0))
        return say("Width and height must be 10 mm to 100 m.");
    draft_.screen = of_frame(T_screen_glass(), width_m, height_m);
    draft_.screen_measured = true;
    if (screen_.taken() == 0) return;
    const CalibrationStep here = std::exchange(step_, CalibrationStep::screen);
    fit();
    step_ = here;
}

void Calibration::use_measured_size() {
    if (measured_size_m_.x() > 0.0) set_picture_size(measured_size_m_.x(), measured_size_m_.y());
}

void Calibration::set_screen(const ScreenPlace& place) {
    for (const Vec3& corner : {place.lower_left_m, place.lower_right_m, place.upper_left_m})
        if (!within(corner, 100.0)) return say("Corners must be numbers, at most 100 m.");
    if (!place.possible())
        return say(
            "These corners do not form a rectangle of 1 cm to 100 m: the edges at the lower left must be "
            "perpendicular "
            "within two degrees.");
    draft_.screen = place;
    draft_.screen_measured = true;
    screen_ = {};
    measured_size_m_.setZero();
    typed_screen_ = true;
    say("Corners set as typed.");
}

void Calibration::set_wand_tip(const Vec3& tip_sensor_m) {
    if (!within(tip_sensor_m, kTipMostM)) return say("The tip must be within a metre of the sensor.");
    draft_.wand_tip_sensor_m = tip_sensor_m;
    pivot_.reset();
}

void Calibration::set_eyes(const EyesOfHead& eyes) {
    if (!(eyes.apart_m >= 0.0 && eyes.apart_m <= kEyesApartMostM))
        return say("The eye distance must be 0 to 200 mm.");
    if (!within(eyes.middle_head_m, kMiddleMostM))
        return say("The eyes must be within half a metre of the sensor on the glasses.");
    draft_.eyes = eyes;
}

}  // namespace tact
