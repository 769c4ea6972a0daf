#include "gui/stereo/calibration.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace tact {

Vec3 Calibration::glass_m(std::size_t mark) const {
    return {(kMarkPlaces[mark][0] - 0.5) * draft_.screen.width_m(),
            (kMarkPlaces[mark][1] - 0.5) * draft_.screen.height_m(), 0.0};
}

Pose Calibration::T_screen_glass() const {
    const Vec3 right = draft_.screen.right(), towards = draft_.screen.towards_viewer();
    Eigen::Matrix3d axes;
    axes << right, towards.cross(right), towards;
    return {draft_.screen.centre_m(), Quat(axes).normalized()};
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
    message_.clear();
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

Calibration::Lacking Calibration::lacking() const {
    const bool screen = step_ == CalibrationStep::screen, hand = step_ == CalibrationStep::workspace,
               wand = step_ == CalibrationStep::wand || screen || (hand && by_wand_);
    if ((screen || (hand && !by_wand_)) && !draft_.screen_measured) return Lacking::size;
    if (wand && !(input_.now_s - sensor_heard_s_ < kAwayS)) return Lacking::tracker;
    if (hand && !(input_.now_s - hand_heard_s_ < kAwayS)) return Lacking::hand;
    return Lacking::nothing;
}

void Calibration::take() {
    message_.clear();
    if (measuring()) {
        wand_.stop();
        stylus_.stop();
        turning_ = false;
        return say("Stopped.");
    }
    switch (lacking()) {
        case Lacking::size:
            return say("The display size is missing: type it in step 1.");
        case Lacking::tracker:
            return say("No data from the tracker. Check its configuration and the sensor's range.");
        case Lacking::hand:
            return say("No data from the haptic device. Check that the controller runs.");
        case Lacking::nothing:
            break;
    }
    if (step_ == CalibrationStep::wand) {
        turning_ = true;
        turned_.clear();
        turning_from_s_ = input_.now_s;
        return;
    }
    if (step_ != CalibrationStep::screen && step_ != CalibrationStep::workspace) return;
    Marks& marks = own_marks();
    if (marks.current >= kMarks)
        return say("All marks are measured: Enter continues; click one to repeat it.");
    const bool hand = step_ == CalibrationStep::workspace;
    const bool sensor = !hand || by_wand_;
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
            say(window->text(what));
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
    mark.to_m = sensor ? wand_.mean_m() : T_screen_glass() * on_glass_m;
    mark.spread_m = std::max(sensor ? wand_.spread_m() : 0.0, hand ? stylus_.spread_m() : 0.0);
    mark.samples = sensor ? wand_.samples() : stylus_.samples();
    mark.taken = true;
    wand_.stop();
    stylus_.stop();
    char text[120];
    std::snprintf(text, sizeof text, "Point %zu measured: %zu samples, spread %.1f mm.", marks.current + 1,
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
    say("Point " + std::to_string(mark + 1) + " will be measured again.");
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
    say("All points of this step are cleared.");
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
