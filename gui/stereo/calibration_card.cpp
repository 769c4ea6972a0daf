// Contents of the calibration card, and the values typed there.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "gui/dashboard/widgets.hpp"
#include "gui/stereo/calibration_controller.hpp"

namespace tact {
namespace {

constexpr int kModes = static_cast<int>(std::size(kStereoModes)) - 1;  // all but "off"

Grade grade_of(FitGrade grade) {
    switch (grade) {
        case FitGrade::green:
            return Grade::good;
        case FitGrade::amber:
            return Grade::watch;
        case FitGrade::red:
            return Grade::bad;
        case FitGrade::none:
            break;
    }
    return Grade::unknown;
}

template <std::size_t n>
void put_mm(std::array<double, n>& to, const double* from_m) {
    for (std::size_t i = 0; i < n; ++i) to[i] = 1e3 * from_m[i];
}

Vec3 metres(const std::array<double, 3>& mm) { return 1e-3 * Vec3(mm[0], mm[1], mm[2]); }

}  // namespace

void CalibrationController::take_typed(CalibrationCardState& f) {
    using Typed = CalibrationCardState::Typed;
    Calibration& c = *calibration_;
    switch (std::exchange(f.edited, Typed::none)) {
        case Typed::none:
            break;
        case Typed::size:
            c.set_picture_size(1e-3 * f.width_mm[0], 1e-3 * f.height_mm[0]);
            break;
        case Typed::tip:
            c.set_wand_tip(metres(f.tip_mm));
            break;
        case Typed::corners:
            c.set_screen({metres(f.corners_mm[0]), metres(f.corners_mm[1]), metres(f.corners_mm[2])});
            break;
        case Typed::eyes:
            c.set_eyes({.apart_m = 1e-3 * f.apart_mm[0],
                        .middle_head_m = metres(f.middle_mm),
                        .swapped = f.swapped});
            break;
        case Typed::mode:
            c.set_mode(static_cast<StereoMode>(std::clamp(f.mode, 0, kModes - 1) + 1));
            break;
        case Typed::place:
            c.set_in_workspace(f.place == 1);
            break;
        case Typed::touched_with:
            c.set_workspace_by_wand(f.touched_with == 1);
            break;
    }
}

void CalibrationController::tell(CalibrationCardState& f) const {
    const Calibration& c = *calibration_;
    f.open = true;
    f.step = static_cast<std::size_t>(c.step());
    f.steps.resize(kCalibrationSteps);
    for (std::size_t i = 0; i < kCalibrationSteps; ++i) {
        const auto step = static_cast<CalibrationStep>(i);
        const Calibration::StatusText v = c.status(step);
        f.steps[i] = {calibration_step_title(step), v.text, grade_of(v.grade)};
    }
    const Calibration::StatusText status = c.status();
    f.status = {grade_of(status.grade), status.text};
    f.instruction = c.instruction();
    f.live = c.live();
    f.message = c.message();
    f.measuring = c.measuring();
    f.progress = static_cast<float>(c.progress());
    const bool lit = c.lacking() != Calibration::Lacking::size;
    f.can_take = c.measuring() || (lit && c.marks().current < kMarks);
    f.size_offered = c.measured_size_m().x() > 0.0;
    f.points.resize(kMarks);
    for (std::size_t i = 0; i < kMarks; ++i) {
        const Calibration::Mark& mark = c.marks().mark[i];
        const auto left = c.marks().residual_m(i);
        CalibrationCardState::Point& p = f.points[i];
        p.taken = mark.taken;
        p.current = lit && c.marks().current == i;
        p.grade = !left                      ? Grade::unknown
                  : c.marks().outlier() == i ? Grade::bad
                  : *left <= kGreenWorstM    ? Grade::good
                  : *left <= kAmberWorstM    ? Grade::watch
                                             : Grade::bad;
        p.text = !mark.taken ? std::string(p.current ? "now" : "-")
                 : left      ? format("error %.1f mm, spread %.1f mm", 1e3 * *left, 1e3 * mark.spread_m)
                             : format("done, spread %.1f mm", 1e3 * mark.spread_m);
    }
    f.file = file_.filename().string();
    f.saved = saved_;
    f.saved_grade = saved_grade_;
    f.changed = stage_text(c.draft()) != stage_text(kept_);
    f.modes.assign(std::begin(kStereoModes) + 1, std::end(kStereoModes));
    if (f.editing) return;
    const StageSettings& s = c.draft();
    f.width_mm = {1e3 * s.screen.width_m()};
    f.height_mm = {1e3 * s.screen.height_m()};
    put_mm(f.tip_mm, s.wand_tip_sensor_m.data());
    put_mm(f.corners_mm[0], s.screen.lower_left_m.data());
    put_mm(f.corners_mm[1], s.screen.lower_right_m.data());
    put_mm(f.corners_mm[2], s.screen.upper_left_m.data());
    f.apart_mm = {1e3 * s.eyes.apart_m};
    put_mm(f.middle_mm, s.eyes.middle_head_m.data());
    f.swapped = s.eyes.swapped;
    f.mode = static_cast<int>(s.mode) - 1;
    f.place = s.in_workspace ? 1 : 0;
    f.touched_with = c.workspace_by_wand() ? 1 : 0;
}

}  // namespace tact
