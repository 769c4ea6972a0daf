#include "gui/stereo/stage.hpp"

namespace tact {

Stage::Stage(const StageSettings& settings, GLFWwindow* dashboard, bool hidden, bool paced_by_display)
    : settings_(settings), head_(Pose{settings.rest_screen_m, Quat::Identity()}) {
    if (settings.own_windows())
        windows_ = std::make_unique<StageWindows>(dashboard, settings, hidden, paced_by_display);
}

void Stage::follow(const HeadTopic* head, std::int64_t now_ns, double frame_s, const PixelArea& view) {
    head_.follow(head, now_ns, now_ns + static_cast<std::int64_t>(1e9 * (frame_s + settings_.latency_s)));
    view_ = view;
    width_px_ = windows_ ? windows_->width_px() : view.width_px;
    height_px_ = windows_ ? windows_->height_px() : view.height_px;
    pictures_.resize(settings_.mode, width_px_, height_px_);
}

// As measured, or with a monitor's height and the output's aspect.
ScreenPlace Stage::screen() const {
    if (settings_.screen_measured) return settings_.screen;
    const double height_m = settings_.screen.height_m();
    return ScreenPlace::of_size(height_m * width_px_ / height_px_, height_m);
}

EyeView Stage::eye(std::size_t eye, const Camera& camera, double world_per_model, const Vec3& centre_world_m,
                   float radius_a) const {
    const ScreenPlace on = screen();
    const ScenePlace scene = settings_.in_workspace
                                 ? in_workspace(world_per_model, centre_world_m, settings_.T_screen_world)
                                 : orbiting(camera, on);
    const Vec3 target_a =
        settings_.in_workspace ? Vec3(Vec3::Zero()) : Vec3(camera.target_a().cast<double>());
    return through_screen(on, scene, eyes_of(head_.pose(), settings_.eyes)[eye],
                          static_cast<double>(radius_a), target_a);
}

EyeView Stage::eye_on_glass(std::size_t eye, double reach_mm) const {
    const ScreenPlace on = screen();
    Eigen::Matrix3d axes;
    axes << on.right(), on.towards_viewer().cross(on.right()), on.towards_viewer();
    return through_screen(on, {1e-3, Quat(axes), on.centre_m()}, eyes_of(head_.pose(), settings_.eyes)[eye],
                          reach_mm, Vec3::Zero());
}

void Stage::place(const StageSettings& settings) {
    settings_.screen = settings.screen;
    settings_.screen_measured = settings.screen_measured;
    settings_.eyes = settings.eyes;
    settings_.rest_screen_m = settings.rest_screen_m;
    settings_.T_screen_world = settings.T_screen_world;
    settings_.in_workspace = settings.in_workspace;
    settings_.latency_s = settings.latency_s;
}

void Stage::show(GLuint dashboard_frame) {
    if (!windows_) {
        pictures_.compose(dashboard_frame, view_.x_px, view_.y_px);
        return;
    }
    if (two_pictures())
        windows_->show(pictures_.texture(0), pictures_.texture(1), pictures_.eye_width_px(),
                       pictures_.eye_height_px());
    else
        windows_->show(pictures_.composed(), 0, width_px_, height_px_);
    pictures_.show_one(0, dashboard_frame, view_);
}

std::vector<Image> Stage::pictures() { return pictures_.read(two_pictures()); }

std::string stage_text(const Stage& stage) {
    std::string words = stereo_mode_text(stage.settings().mode);
    switch (stage.head().sight()) {
        case HeadSight::seen:
            words += ", follows the head";
            break;
        case HeadSight::lost:
            words += ", head lost: the view stands still";
            break;
        case HeadSight::none:
            words += ", no head tracking";
            break;
    }
    if (stage.settings().eyes.swapped) words += ", eyes swapped";
    return words;
}

}  // namespace tact
