// A stereo picture of the scene that stands still in the room while the head moves.
//
// A frame  follow() takes the head to the time of display; eye() gives what each eye sees; begin() binds its picture, into
//          which the caller draws; show() puts both together, in the dashboard's view or in windows of their own, where
//          the view then shows what the left eye sees.
// Thread   frame thread, the dashboard's context current.  Fails by StartupError, when it is made or resized.
#pragma once

#include <memory>

#include "gui/stereo/eye_pictures.hpp"
#include "gui/stereo/head_view.hpp"
#include "gui/stereo/stage_windows.hpp"

namespace tact {

class Stage {
public:
    Stage(const StageSettings& settings, GLFWwindow* dashboard, bool hidden, bool paced_by_display);

    [[nodiscard]] const StageSettings& settings() const { return settings_; }
    [[nodiscard]] const HeadView& head() const { return head_; }
    void swap_eyes() { settings_.eyes.swapped = !settings_.eyes.swapped; }
    // A window of the picture was closed.
    [[nodiscard]] bool close_wanted() const { return windows_ && windows_->close_wanted(); }

    // view: the dashboard's. frame_s: until what is drawn now is shown.
    void follow(const HeadTopic* head, std::int64_t now_ns, double frame_s, const PixelArea& view);
    // centre_world_m: the scene's origin; radius_a: of a ball about it that holds the scene.
    [[nodiscard]] EyeView eye(std::size_t eye, const Camera& camera, double world_per_model,
                              const Vec3& centre_world_m, float radius_a) const;
    // Of a scene in millimetres on the glass, see picture_pen.hpp; reach_mm: how far from its middle anything may lie.
    [[nodiscard]] EyeView eye_on_glass(std::size_t eye, double reach_mm) const;
    // The picture as large as it is taken to be, and where it is.
    [[nodiscard]] ScreenPlace screen() const;
    // From now on; the mode, the monitors and the size of windows stay as they are.
    void place(const StageSettings& settings);
    void begin(std::size_t eye, const Eigen::Vector3f& ground) { pictures_.begin(eye, ground); }
    [[nodiscard]] int eye_width_px() const { return pictures_.eye_width_px(); }
    [[nodiscard]] int eye_height_px() const { return pictures_.eye_height_px(); }
    // dashboard_frame: its frame buffer, bound again at the end.
    void show(GLuint dashboard_frame);
    // Of what was shown: one, or one for each eye.
    [[nodiscard]] std::vector<Image> pictures();

private:
    [[nodiscard]] bool two_pictures() const {
        return settings_.mode == StereoMode::two_windows || settings_.mode == StereoMode::quad_buffer;
    }

    StageSettings settings_;
    HeadView head_;
    EyePictures pictures_;
    std::unique_ptr<StageWindows> windows_;
    PixelArea view_;
    int width_px_ = 1, height_px_ = 1;  // of the output
};

// How it is shown and what becomes of the head, in words.
[[nodiscard]] std::string stage_text(const Stage& stage);

}  // namespace tact
