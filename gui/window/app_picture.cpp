#include <spdlog/spdlog.h>

#include "gui/base/output_folder.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"

namespace tact {
namespace {

// So many pixels are drawn with four samples each: more takes seconds, in which the window stands still.
constexpr double kSamplesMax = 9e6, kSamplesMaxSoftware = 2.1e6;

// Of glass sorted at each pixel: each draws the surface once more.
constexpr int kGlassLayersSoftware = 5;

}  // namespace

// The frame was prepared as for a screenshot: everything in full detail.
void GuiApp::save_picture(const ViewFrame& of_window) {
    PictureState& wanted = state_.picture;
    wanted.save_wanted = false;
    system().refine();
    view_->contours().set_refined(true);
    try {
        const EyeView eye =
            camera_.eye(static_cast<float>(wanted.width_px) / static_cast<float>(wanted.height_px));
        const StillPicture picture = draw_still_picture(
            wanted.width_px, wanted.height_px, wanted.transparent,
            window_.software() ? kSamplesMaxSoftware : kSamplesMax,
            [&](int width_px, int height_px, bool many_samples, const Eigen::Vector3f* ground) {
                ViewOptions options = view_options_;
                options.smooth_edges = !many_samples && !wanted.transparent;
                options.shaded = state_.toggles.shading;
                options.light_by_pixel = true;
                options.glass_layers = window_.software() ? kGlassLayersSoftware : kGlassLayers;
                if (ground != nullptr) {
                    options.gradient = false;
                    options.plain_ground = *ground;
                }
                ViewFrame frame = of_window;
                frame.x_px = frame.y_px = 0;
                frame.width_px = width_px;
                frame.height_px = height_px;
                frame.passes = nullptr;
                paint_view_ground(*programs_, options.plain());
                view_->draw(eye, options, frame);
            });
        const std::filesystem::path path = new_output("picture", ".png");
        write_png(path, picture.width_px, picture.height_px, picture.pixels,
                  picture.transparent ? PngFormat::rgba : PngFormat::rgb);
        spdlog::info("wrote {}", path.string());
        wanted.result = {Grade::good, "saved: " + path.string()};
    } catch (const StartupError& e) {
        spdlog::error("{}", e.what());
        wanted.result = {Grade::bad, e.what()};
    }
    view_->contours().set_refined(false);
    glClear(GL_DEPTH_BUFFER_BIT);
}

}  // namespace tact
