// Texts of the calibration for the user.
#include <cmath>
#include <cstdio>

#include "gui/stereo/calibration.hpp"

namespace tact {
namespace {

constexpr double kStretchTold = 0.01;

std::string text_of(const char* pattern, auto... values) {
    char text[400];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

std::string fit_text(const Registration& fit) {
    return text_of("%s: %.1f mm rms, worst %.1f mm", fit_grade_text(fit.grade()), 1e3 * fit.residual_m_rms,
                   1e3 * fit.residual_m_max);
}

Calibration::StatusText status_of(const Calibration::Marks& marks, bool taken_before, const char* what) {
    if (marks.taken() == 0)
        return {FitGrade::none,
                taken_before ? std::string("from the file") : std::string("not measured yet")};
    if (marks.taken() < kMarksMin)
        return {FitGrade::none,
                text_of("%zu of %zu points (at least %zu)", marks.taken(), kMarks, kMarksMin)};
    const Registration& fit = marks.fit;
    if (fit.residual_m.empty()) return {FitGrade::red, fit.refusal};
    std::string words = fit_text(fit);
    if (const auto out = marks.outlier())
        words += text_of(". Point %zu does not fit the others: measure it again", *out + 1);
    else if (!fit.good)
        words += text_of(
            ". Worst: point %zu. Check the order of the points, metal nearby, and the "
            "size.",
            marks.of_fit[fit.worst_pair] + 1);
    if (!fit.good) words += text_of(". %s is unchanged", what);
    return {fit.good ? fit.grade() : FitGrade::red, words};
}

}  // namespace

const char* calibration_step_title(CalibrationStep step) {
    static constexpr const char* kTitles[] = {"Display", "Wand", "Screen", "Workspace", "Eyes", "Check"};
    return kTitles[static_cast<std::size_t>(step)];
}

std::string Calibration::instruction() const {
    const bool marks_step = step_ == CalibrationStep::screen || step_ == CalibrationStep::workspace;
    if (marks_step && marks().current >= kMarks)
        return "All points are measured: Enter continues. Click a point to repeat it.";
    switch (step_) {
        case CalibrationStep::picture:
            return "Measure the width and height of the lit display between the outer edges of the frame "
                   "shown, "
                   "and type them.";
        case CalibrationStep::wand:
            return "The tracked sensor is the wand: the one on the glasses, or head_sensor of tact.toml. "
                   "Type the position "
                   "of its tip, or press T, put the tip into a hollow and tilt the wand to all "
                   "sides for eight "
                   "seconds. 0, 0, 0: the sensor itself touches.";
        case CalibrationStep::screen:
            return draft_.screen_measured ? "Touch the lit mark on the glass with the wand's tip, press "
                                            "T (or the stylus's button) and "
                                            "hold still for a second. Or type the corners below."
                                          : "The display size is missing: type it in step 1, or type "
                                            "the corners below.";
        case CalibrationStep::workspace:
            if (!by_wand_ && !draft_.screen_measured)
                return "The display size is missing: type it in step 1. Or touch the wand, which needs "
                       "no "
                       "size.";
            return by_wand_ ? "Hold the stylus's tip to the wand's tip, both still, and press T. Choose "
                              "points at least "
                              "10 cm apart, not all in one plane, where the hand will work."
                            : "Touch the lit mark on the glass with the stylus's tip, press T or its "
                              "button, and hold "
                              "still for a second. N skips a mark out of reach; four are enough.";
        case CalibrationStep::eyes:
            return "The left eye must see only LEFT, the right eye only RIGHT; otherwise "
                   "swap them. The "
                   "distance of the pupils is on an eyeglass prescription. Move the head: content on "
                   "the glass must stand "
                   "still.";
        case CalibrationStep::check:
            return "The circle must be round, the grid match a ruler, the stairs rise towards you "
                   "from left to right, "
                   "and the cross sit on the stylus's tip, wherever you stand. Then save.";
    }
    return {};
}

std::string Calibration::glass_text() const {
    const std::string point = std::to_string(marks().current + 1);
    if (measuring())
        return step_ == CalibrationStep::wand ? "TILT THE WAND TO ALL SIDES" : "HOLD STILL: POINT " + point;
    if (marks().current >= kMarks && step_ != CalibrationStep::wand) {
        const auto out = marks().outlier();
        return out ? "POINT " + std::to_string(*out + 1) + " DOES NOT FIT" : "ALL POINTS DONE";
    }
    switch (lacking()) {
        case Lacking::size:
            return "FIRST TYPE THE DISPLAY SIZE";
        case Lacking::tracker:
            return "NO SENSOR TRACKED";
        case Lacking::hand:
            return "NO DATA FROM THE STYLUS";
        case Lacking::nothing:
            break;
    }
    if (step_ == CalibrationStep::wand) return "WAND: PUT ITS TIP INTO A HOLLOW";
    if (step_ == CalibrationStep::screen) return "WAND: TOUCH MARK " + point;
    return by_wand_ ? "STYLUS TO WAND: POINT " + point : "STYLUS: TOUCH MARK " + point;
}

std::string Calibration::live() const {
    if (turning_)
        return text_of("tilt the wand to all sides: %.0f %%, %zu poses%s", 100.0 * progress(), turned_.size(),
                       input_.sensor_good ? "" : "; sensor not tracked");
    std::string words = wand_.measuring() ? wand_.text("the wand") : std::string();
    if (stylus_.measuring()) words += (words.empty() ? "" : "; ") + stylus_.text("the stylus");
    if (!words.empty()) return words;
    const auto place = [](const char* what, const Vec3& at_m) {
        return text_of("%s: %.1f, %.1f, %.1f mm", what, 1e3 * at_m.x(), 1e3 * at_m.y(), 1e3 * at_m.z());
    };
    const bool hand = step_ == CalibrationStep::workspace || step_ == CalibrationStep::check,
               sensor = step_ == CalibrationStep::wand || step_ == CalibrationStep::screen ||
                        (step_ == CalibrationStep::workspace && by_wand_);
    if (sensor) {
        const auto tip = wand_tip_screen_m();
        words = tip ? place("wand's tip", *tip) : "No sensor tracked.";
    }
    if (hand) {
        const auto tip = stylus_screen_m();
        words += (words.empty() ? "" : "\n") +
                 (tip ? place("stylus's tip", *tip) : std::string("No data from the haptic device."));
    }
    return words;
}

Calibration::StatusText Calibration::status() const { return status(step_); }

Calibration::StatusText Calibration::status(CalibrationStep step) const {
    switch (step) {
        case CalibrationStep::picture:
            if (!draft_.screen_measured) return {FitGrade::none, "not typed yet"};
            return {FitGrade::green,
                    text_of("%.1f x %.1f mm", 1e3 * draft_.screen.width_m(), 1e3 * draft_.screen.height_m())};
        case CalibrationStep::wand: {
            const Vec3 t_mm = 1e3 * draft_.wand_tip_sensor_m;
            std::string words = text_of("tip at %.1f, %.1f, %.1f mm", t_mm.x(), t_mm.y(), t_mm.z());
            if (!pivot_ || !pivot_->good) return {FitGrade::none, words};
            return {fit_grade(pivot_->residual_m_rms, pivot_->residual_m_rms),
                    words + text_of(", pivot error %.1f mm rms", 1e3 * pivot_->residual_m_rms)};
        }
        case CalibrationStep::screen: {
            if (typed_screen_) return {FitGrade::none, "as typed"};
            StatusText v = status_of(screen_, draft_.screen_measured, "The screen");
            const Eigen::Vector2d by = measured_size_m_;
            if (by.x() > 0.0 && !screen_.outlier()) {
                const double w = by.x() / draft_.screen.width_m() - 1.0,
                             h = by.y() / draft_.screen.height_m() - 1.0;
                v.text += text_of(". Size by the marks: %.1f x %.1f mm", 1e3 * by.x(), 1e3 * by.y());
                if (std::max(std::abs(w), std::abs(h)) > kStretchTold) {
                    v.text += text_of(", %+.1f %% and %+.1f %% off the typed size: measure again, or use it",
                                      100.0 * w, 100.0 * h);
                    if (v.grade == FitGrade::green) v.grade = FitGrade::amber;
                }
            }
            return v;
        }
        case CalibrationStep::workspace: {
            StatusText v = status_of(workspace_, true, "The workspace");
            if (workspace_.fit.good && std::abs(workspace_.fit.stretch - 1.0) > 2.0 * kStretchTold) {
                v.text += text_of(". The arm's lengths are %+.1f %% off the tracker's: check its calibration",
                                  100.0 / workspace_.fit.stretch - 100.0);
                if (v.grade == FitGrade::green) v.grade = FitGrade::amber;
            }
            return v;
        }
        case CalibrationStep::eyes:
            return {FitGrade::none,
                    text_of("%.1f mm apart%s, %s", 1e3 * draft_.eyes.apart_m,
                            draft_.eyes.swapped ? ", swapped" : "", stereo_mode_text(draft_.mode))};
        case CalibrationStep::check:
            return {};
    }
    return {};
}

std::vector<std::string> Calibration::remarks() const {
    std::vector<std::string> lines;
    for (const CalibrationStep step : {CalibrationStep::picture, CalibrationStep::wand,
                                       CalibrationStep::screen, CalibrationStep::workspace})
        lines.push_back(std::string(calibration_step_title(step)) + ": " + status(step).text);
    const auto add = [&](const char* what, const Marks& marks) {
        for (std::size_t i = 0; i < kMarks; ++i)
            if (const auto left = marks.residual_m(i))
                lines.push_back(text_of("%s point %zu: error %.2f mm, spread %.2f mm", what, i + 1,
                                        1e3 * *left, 1e3 * marks.mark[i].spread_m));
    };
    add("screen", screen_);
    add("workspace", workspace_);
    return lines;
}

}  // namespace tact
