// A stereo display of the scene that stands still in the room while the head moves.
//
// A frame  follow() predicts the head at the time of display; eye() gives each eye's view; begin() binds its image,
//          into which the caller draws; show() composes both, in the dashboard's view or in separate windows; the
//          dashboard then shows the left eye's image.
// Thread   frame thread, the dashboard's context current.  Fails by StartupError on construction or resizing.
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
    // The user closed a window of the stereo display.
    [[nodiscard]] bool close_wanted() const { return windows_ && windows_->close_wanted(); }

    // view: of the dashboard. frame_s: time until the current frame is displayed.
    void follow(const HeadTopic* head, std::int64_t now_ns, double frame_s, const PixelArea& view);
    // centre_world_m: the scene's origin; radius_a: of a ball about it that contains the scene.
    [[nodiscard]] EyeView eye(std::size_t eye, const Camera& camera, double world_per_model,
                              const Vec3& centre_world_m, float radius_a) const;
    // For a scene in millimetres on the glass, see picture_pen.hpp; reach_mm: greatest distance of content from its
    // centre.
    [[nodiscard]] EyeView eye_on_glass(std::size_t eye, double reach_mm) const;
    // The display area in the size in use, and its pose.
    [[nodiscard]] ScreenPlace screen() const;
    // Applies these settings; mode, monitors and window size stay unchanged.
    void place(const StageSettings& settings);
    void begin(std::size_t eye, const Eigen::Vector3f& ground) { pictures_.begin(eye, ground); }
    [[nodiscard]] int eye_width_px() const { return pictures_.eye_width_px(); }
    [[nodiscard]] int eye_height_px() const { return pictures_.eye_height_px(); }
    // dashboard_frame: its framebuffer, bound again at the end.
    void show(GLuint dashboard_frame);
    // Images of the last output: one, or one for each eye.
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

// Stereo mode and head tracking as text.
[[nodiscard]] std::string stage_text(const Stage& stage);

}  // namespace tact
