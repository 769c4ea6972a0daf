#include "gui/stage/calibration.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tact {
namespace {

constexpr double kEyesApartMostM = 0.2, kMiddleMostM = 0.5, kTipMostM = 1.0;

// What a stage file takes.
bool within(const Vec3& v, double most) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

ScreenPlace of_frame(const Pose& T_screen_glass, double width_m, double height_m) {
    const ScreenPlace flat = ScreenPlace::of_size(width_m, height_m);
    return {T_screen_glass * flat.lower_left_m, T_screen_glass * flat.lower_right_m,
            T_screen_glass * flat.upper_left_m};
}

Pose glass_of(const ScreenPlace& screen) {
    const Vec3 right = screen.right(), towards = screen.towards_viewer();
    Eigen::Matrix3d axes;
    axes << right, towards.cross(right), towards;
    return {screen.centre_m(), Quat(axes).normalized()};
}

// Lengths of the picture by the marks alone: the plane that best holds them, stretched along both axes as it likes.
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

Vec3 Calibration::glass_m(std::size_t mark) const {
    return {(kMarkPlaces[mark][0] - 0.5) * draft_.screen.width_m(),
            (kMarkPlaces[mark][1] - 0.5) * draft_.screen.height_m(), 0.0};
}

std::optional<Vec3> Calibration::wand_tip_screen_m() const {
    if (!input_.sensor_good) return std::nullopt;
    return input_.T_screen_sensor * draft_.wand_tip_sensor_m;
}

std::optional<Vec3> Calibration::stylus_screen_m() const {
    if (!input_.hand_good) return std::nullopt;
    return draft_.T_screen_world * input_.stylus_world_m;
}

bool Calibration::measuring() const { return turning_ || wand_.measuring() || stylus_.measuring(); }

double Calibration::progress() const {
    if (turning_) return std::clamp((input_.now_s - turning_from_s_) / kTurningS, 0.0, 1.0);
    if (wand_.measuring() && stylus_.measuring()) return std::min(wand_.progress(), stylus_.progress());
    return wand_.measuring() ? wand_.progress() : stylus_.progress();
}

void Calibration::go(CalibrationStep step) {
    wand_.stop();
    stylus_.stop();
    turning_ = false;
    said_.clear();
    last_taken_ = kMarks;
    step_ = step;
}

void Calibration::follow(const CalibrationInput& input) {
    input_ = input;
    input_.sensor_good = input.sensor_good && input.T_screen_sensor.finite();
    input_.hand_good = input.hand_good && input.stylus_world_m.allFinite();
    if (input_.sensor_good) sensor_heard_s_ = input_.now_s;
    if (input_.hand_good) hand_heard_s_ = input_.now_s;
    const bool pressed = input_.hand_good && input_.button && !button_before_;
    button_before_ = input_.button;
    if (pressed && !measuring() && step_ != CalibrationStep::picture && step_ < CalibrationStep::eyes) take();
    if (turning_) follow_turning();
    if (wand_.measuring() || stylus_.measuring()) follow_mark();
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
        say("Not taken: " + pivot_->refusal + ".");
    } else if (!within(pivot_->tip_sensor_m, kTipMostM)) {
        pivot_->good = false;
        say("Not taken: the tip came out more than a metre from the sensor; turn farther, about one place.");
    } else {
        draft_.wand_tip_sensor_m = pivot_->tip_sensor_m;
        say("The tip is measured.");
    }
}

void Calibration::take() {
    said_.clear();
    if (measuring()) {
        wand_.stop();
        stylus_.stop();
        turning_ = false;
        return say("Stopped.");
    }
    const bool sensor_there = input_.now_s - sensor_heard_s_ < kAwayS,
               hand_there = input_.now_s - hand_heard_s_ < kAwayS;
    if (step_ == CalibrationStep::wand) {
        if (!sensor_there)
            return say("Nothing is heard of the tracker: is one configured, and is the sensor in reach?");
        turning_ = true;
        turned_.clear();
        turning_from_s_ = input_.now_s;
        return;
    }
    if (step_ != CalibrationStep::screen && step_ != CalibrationStep::workspace) return;
    Marks& marks = own_marks();
    if (marks.current >= kMarks)
        return say("All marks are taken: Enter goes on; click one to take it again.");
    const bool hand = step_ == CalibrationStep::workspace;
    const bool sensor = !hand || by_wand_;
    if (sensor && !sensor_there)
        return say("Nothing is heard of the tracker: is one configured, and is the sensor in reach?");
    if (hand && !hand_there) return say("Nothing is heard of the hand's device: is the controller running?");
    if (sensor) wand_.start(input_.now_s);
    if (hand) stylus_.start(input_.now_s);
}

void Calibration::follow_mark() {
    if (wand_.measuring())
        wand_.add(input_.now_s, input_.sensor_at_ns, input_.T_screen_sensor * draft_.wand_tip_sensor_m,
                  input_.sensor_good);
    if (stylus_.measuring())
        stylus_.add(input_.now_s, input_.hand_at_ns, input_.stylus_world_m, input_.hand_good);
    const bool hand = step_ == CalibrationStep::workspace, sensor = !hand || by_wand_;
    using State = RestWindow::State;
    for (const auto& [window, what] : {std::pair{&wand_, "the wand"}, std::pair{&stylus_, "the stylus"}})
        if (window->state() == State::failed) {
            say(window->words(what));
            wand_.stop();
            stylus_.stop();
            return;
        }
    const bool wand_done = !sensor || wand_.state() == State::done,
               stylus_done = !hand || stylus_.state() == State::done;
    if (wand_done && stylus_done) keep_mark();
}

void Calibration::keep_mark() {
    const bool hand = step_ == CalibrationStep::workspace, sensor = !hand || by_wand_;
    Marks& marks = own_marks();
    Mark& mark = marks.mark[marks.current];
    const Vec3 on_glass_m = glass_m(marks.current);
    mark.from_m = hand ? stylus_.mean_m() : on_glass_m;
    mark.to_m = sensor ? wand_.mean_m() : glass_of(draft_.screen) * on_glass_m;
    mark.spread_m = std::max(sensor ? wand_.spread_m() : 0.0, hand ? stylus_.spread_m() : 0.0);
    mark.samples = sensor ? wand_.samples() : stylus_.samples();
    mark.taken = true;
    wand_.stop();
    stylus_.stop();
    char text[120];
    std::snprintf(text, sizeof text, "Point %zu is taken: %zu samples, spread %.1f mm.", marks.current + 1,
                  mark.samples, 1e3 * mark.spread_m);
    say(text);
    last_taken_ = marks.current;
    skip();
    fit();
}

void Calibration::skip() {
    if (step_ != CalibrationStep::screen && step_ != CalibrationStep::workspace) return;
    Marks& marks = own_marks();
    for (std::size_t i = 1; i <= kMarks; ++i) {
        const std::size_t next = (marks.current + i) % kMarks;
        if (marks.mark[next].taken) continue;
        marks.current = next;
        return;
    }
    marks.current = kMarks;
}

void Calibration::redo(std::size_t mark) {
    if (mark >= kMarks || (step_ != CalibrationStep::screen && step_ != CalibrationStep::workspace)) return;
    wand_.stop();
    stylus_.stop();
    Marks& marks = own_marks();
    marks.mark[mark] = {};
    marks.current = mark;
    fit();
    say("Point " + std::to_string(mark + 1) + " is to be taken again.");
}

void Calibration::redo_last() {
    if (last_taken_ < kMarks) redo(last_taken_);
    last_taken_ = kMarks;
}

void Calibration::clear() {
    if (step_ != CalibrationStep::screen && step_ != CalibrationStep::workspace) return;
    wand_.stop();
    stylus_.stop();
    own_marks() = {};
    if (step_ == CalibrationStep::screen) measured_size_m_.setZero();
    last_taken_ = kMarks;
    say("All points of this step are forgotten.");
}

void Calibration::fit() {
    Marks& marks = own_marks();
    std::vector<PointPair> pairs;
    marks.of_fit.clear();
    for (std::size_t i = 0; i < kMarks; ++i) {
        const Mark& m = marks.mark[i];
        if (!m.taken) continue;
        // On the glass, by the size that it has now.
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
        return say("The picture is between 10 mm and 100 m wide and high.");
    draft_.screen = of_frame(glass_of(draft_.screen), width_m, height_m);
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
        if (!within(corner, 100.0)) return say("A corner is not a number, or farther than 100 m.");
    if (!place.possible())
        return say(
            "These corners are no rectangle of 1 cm to 100 m an edge: its edges at the lower left have to be "
            "upright on "
            "each other within two degrees.");
    draft_.screen = place;
    draft_.screen_measured = true;
    screen_ = {};
    measured_size_m_.setZero();
    typed_screen_ = true;
    say("The corners are taken as typed.");
}

void Calibration::set_wand_tip(const Vec3& tip_sensor_m) {
    if (!within(tip_sensor_m, kTipMostM)) return say("The tip is within a metre of the sensor.");
    draft_.wand_tip_sensor_m = tip_sensor_m;
    pivot_.reset();
}

void Calibration::set_eyes(const EyesOfHead& eyes) {
    if (!(eyes.apart_m >= 0.0 && eyes.apart_m <= kEyesApartMostM)) return say("Eyes are 0 to 200 mm apart.");
    if (!within(eyes.middle_head_m, kMiddleMostM))
        return say("The eyes are within half a metre of the sensor on the glasses.");
    draft_.eyes = eyes;
}

void Calibration::set_workspace_by_wand(bool by_wand) {
    if (by_wand == by_wand_) return;
    by_wand_ = by_wand;
    if (step_ == CalibrationStep::workspace)
        clear();
    else
        workspace_ = {};
}

}  // namespace tact
