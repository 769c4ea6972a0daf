#include "gui/stereo/calibration_controller.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::int64_t kOldNs = 100'000'000;
constexpr std::uint8_t kFresh = 2;  // TrackerState of the hardware layer, which this process does not include
constexpr std::uint8_t kReady = 1, kFault = 4;  // DeviceState, likewise
constexpr double kToolShownMm = 3000.0;

CalibrationInput input_of(const Controller& c, std::int64_t now_ns) {
    CalibrationInput in;
    in.now_s = 1e-9 * static_cast<double>(now_ns);
    if (!c.attached()) return in;
    const HeadTopic& h = c.head;
    in.sensor_good =
        c.have_head && h.sequence > 0 && h.state == kFresh && std::abs(now_ns - h.taken_at_ns) < kOldNs;
    in.sensor_at_ns = h.taken_at_ns;
    const double* const q = h.quat_screen_head_xyzw;
    in.T_screen_sensor = {Vec3(h.pos_screen_m[0], h.pos_screen_m[1], h.pos_screen_m[2]),
                          Quat(q[3], q[0], q[1], q[2]).normalized()};
    const ToolTopic& t = c.tool;
    in.hand_good = c.have_tool && t.device_state >= kReady && t.device_state < kFault &&
                   std::abs(now_ns - t.taken_at_ns) < kOldNs;
    in.hand_at_ns = t.taken_at_ns;
    in.stylus_world_m = Vec3(t.pos_world_m[0], t.pos_world_m[1], t.pos_world_m[2]);
    in.button = t.buttons != 0;
    return in;
}

}  // namespace

void CalibrationController::begin(const StageSettings& now, bool check_alone) {
    kept_ = now;
    calibration_.emplace(now);
    if (check_alone) calibration_->go(CalibrationStep::check);
    leave_ = false;
    saved_.clear();
    logged_.clear();
    spdlog::info("calibration: started, file {}", file_.string());
}

void CalibrationController::end(CalibrationCardState& state) {
    calibration_.reset();
    state = {};
    spdlog::info("calibration: closed");
}

void CalibrationController::swap_eyes() {
    EyesOfHead eyes = calibration_->draft().eyes;
    eyes.swapped = !eyes.swapped;
    calibration_->set_eyes(eyes);
}

void CalibrationController::perform(CalibrationAction what, std::size_t number) {
    Calibration& c = *calibration_;
    const CalibrationStep before = c.step();
    switch (what) {
        case CalibrationAction::go:
            if (number < kCalibrationSteps) c.go(static_cast<CalibrationStep>(number));
            break;
        case CalibrationAction::next:
            c.next();
            break;
        case CalibrationAction::back:
            c.back();
            break;
        case CalibrationAction::take:
            c.take();
            break;
        case CalibrationAction::skip:
            c.skip();
            break;
        case CalibrationAction::redo:
            c.redo(number);
            break;
        case CalibrationAction::redo_last:
            c.redo_last();
            break;
        case CalibrationAction::clear:
            c.clear();
            break;
        case CalibrationAction::measured_size:
            c.use_measured_size();
            break;
        case CalibrationAction::save:
            save();
            break;
        case CalibrationAction::leave:
            leave_ = true;
            break;
    }
    if (c.step() != before) {
        const Calibration::StatusText status = c.status(before);
        if (!status.text.empty())
            spdlog::info("calibration: {}: {}", calibration_step_title(before), status.text);
        spdlog::info("calibration: step {}, {}", static_cast<int>(c.step()) + 1,
                     calibration_step_title(c.step()));
    }
}

void CalibrationController::save() {
    try {
        const std::filesystem::path old =
            write_stage_file(file_, calibration_->draft(), calibration_->remarks());
        const StageSettings& draft = calibration_->draft();
        if (!is_in_stage_file(draft, file_))
            throw StartupError("reading the stage file '" + file_.string() + "' again",
                               "the content differs from what was written",
                               "save to another file (--stage FILE)");
        kept_ = draft;
        saved_ = "Written to " + file_.string() + " and read back." +
                 (old.empty() ? std::string() : " The old file is kept as " + old.filename().string() + ".");
        saved_grade_ = Grade::good;
    } catch (const StartupError& e) {
        saved_ = e.what();
        saved_grade_ = Grade::bad;
    }
    spdlog::info("calibration: {}", saved_);
}

bool CalibrationController::follow(const Controller& controller, std::int64_t now_ns,
                                   CalibrationCardState& state) {
    const std::string before = stage_text(draft());
    calibration_->follow(input_of(controller, now_ns));
    take_typed(state);
    for (const auto& [what, number] : state.requests) perform(what, number);
    state.requests.clear();
    if (stage_text(draft()) != before) saved_.clear();
    if (calibration_->message() != logged_) {
        logged_ = calibration_->message();
        if (!logged_.empty()) spdlog::info("calibration: {}", logged_);
    }
    tell(state);
    return leave_;
}

void CalibrationController::refuse_mode(StereoMode back_to, const std::string& why) {
    calibration_->set_mode(back_to);
    saved_ = why;
    saved_grade_ = Grade::bad;
}

std::optional<Eigen::Vector3d> CalibrationController::tool_mm() const {
    const auto tip = calibration_->stylus_screen_m();
    if (!tip) return std::nullopt;
    const ScreenPlace& s = draft().screen;
    const Vec3 right = s.right(), towards = s.towards_viewer(), from = *tip - s.centre_m();
    const Eigen::Vector3d at =
        1e3 * Eigen::Vector3d(right.dot(from), towards.cross(right).dot(from), towards.dot(from));
    if (!(at.norm() <= kToolShownMm)) return std::nullopt;
    return at;
}

double CalibrationController::reach_mm(const GlassSize& glass) const {
    const auto tool = tool_mm();
    return std::max(0.6 * std::hypot(glass.width_mm, glass.height_mm), tool ? tool->norm() : 0.0);
}

std::vector<PictureVertex> CalibrationController::picture(const GlassSize& glass, std::size_t eye) const {
    const Calibration& c = *calibration_;
    if (c.step() == CalibrationStep::picture) return frame_picture(glass, c.draft().screen_measured);
    if (c.step() >= CalibrationStep::eyes) return test_picture(glass, {eye, tool_mm()});
    MarksPicture what;
    what.marks = c.step() == CalibrationStep::screen ||
                 (c.step() == CalibrationStep::workspace && !c.workspace_by_wand());
    const bool lit = c.lacking() != Calibration::Lacking::size;
    for (std::size_t i = 0; i < kMarks; ++i)
        what.look[i] = lit && i == c.marks().current ? MarkStyle::current
                       : c.marks().outlier() == i    ? MarkStyle::outlier
                       : c.marks().mark[i].taken     ? MarkStyle::taken
                                                     : MarkStyle::open;
    what.progress = c.progress();
    what.text = c.glass_text();
    return marks_picture(glass, what);
}

}  // namespace tact
