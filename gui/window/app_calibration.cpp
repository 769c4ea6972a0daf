#include <spdlog/spdlog.h>

#include <algorithm>

#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr float kGround[3] = {0.024F, 0.028F, 0.036F};

}  // namespace

void GuiApp::make_stage(const StageSettings& settings) {
    // Closes the old windows first: two windows cannot fill one monitor.
    stage_.reset();
    stage_ = std::make_unique<Stage>(settings, window_.handle(), options_.hidden, window_.paced_by_display());
}

// A driver without this kind of stereo does not end the run: one image for both eyes, and the reason over the view.
void GuiApp::make_stage_or_mono(const StageSettings& settings) {
    state_.stage_refused.clear();
    try {
        make_stage(settings);
    } catch (const StereoRefused& e) {
        spdlog::warn("{}", e.what());
        state_.stage_refused = std::string("Stereo is off, because ") + e.why() + ". To have it, " + e.fix() +
                               " (--stereo MODE, or mode in the stage file).";
    }
}

void GuiApp::open_calibration(bool check_alone) {
    StageSettings now = options_.stage;
    if (stage_) now = stage_->settings();
    calibration_.begin(now, check_alone);
    if (stage_) return;
    // Anaglyph shows the marks on any monitor, to both eyes.
    calibration_.set_mode(StereoMode::anaglyph);
    try {
        make_stage(calibration_.draft());
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        state_.scene.warning = e.what();
        calibration_.end(state_.calibration);
    }
}

void GuiApp::follow_calibration(std::int64_t now_ns) {
    if (!calibration_.open()) return;
    if (calibration_.follow(controller_, now_ns, state_.calibration)) return leave_calibration();
    const StageSettings& draft = calibration_.draft();
    const StereoMode before = stage_->settings().mode;
    if (draft.mode != before) {
        try {
            make_stage(draft);
        } catch (const StartupError& e) {
            spdlog::warn("{}", e.what());
            calibration_.refuse_mode(before, e.what());
            make_stage(calibration_.draft());
        }
    }
    stage_->place(calibration_.draft());
}

void GuiApp::leave_calibration() {
    const StageSettings kept = calibration_.kept();
    calibration_.end(state_.calibration);
    if (kept.mode == StereoMode::off)
        stage_.reset();
    else if (kept.mode != stage_->settings().mode)
        make_stage_or_mono(kept);
    else
        stage_->place(kept);
    if (!stage_) {
        state_.stage.clear();
        state_.head_lost = false;
    }
}

void GuiApp::draw_calibration(const ViewFrame& view, std::int64_t now_ns) {
    if (!calibration_painter_) calibration_painter_ = std::make_unique<PicturePainter>();
    stage_->follow(controller_.attached() && controller_.have_head ? &controller_.head : nullptr, now_ns,
                   clock_.frame_s(), {view.x_px, view.y_px, view.width_px, view.height_px});
    const ScreenPlace screen = stage_->screen();
    GlassSize glass{1e3 * screen.width_m(), 1e3 * screen.height_m(), 1.0};
    glass.px_mm =
        std::max(glass.width_mm / stage_->eye_width_px(), glass.height_mm / stage_->eye_height_px());
    const double reach_mm = calibration_.reach_mm(glass);
    for (std::size_t eye = 0; eye < 2; ++eye) {
        stage_->begin(eye, Eigen::Vector3f(kGround[0], kGround[1], kGround[2]));
        // With swapped eyes a picture is for the other eye, and its word shows that eye.
        const std::size_t meant = stage_->settings().eyes.swapped ? 1 - eye : eye;
        calibration_painter_->draw(stage_->eye_on_glass(eye, reach_mm), calibration_.picture(glass, meant));
    }
    stage_->show(window_.frame_buffer());
    state_.a_per_px = 0.0;  // each eye has its own scale
    state_.stage = std::string("stereo: ") + stage_text(*stage_);
    state_.head_lost = stage_->head().sight() == HeadSight::lost;
}

}  // namespace tact
