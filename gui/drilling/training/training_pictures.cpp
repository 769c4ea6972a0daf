#include "gui/drilling/training/training_pictures.hpp"

#include "gui/render/camera.hpp"
#include "gui/render/target.hpp"
#include "ipc/image/png.hpp"

namespace tact {
namespace {

constexpr int kWidthPx = 800, kHeightPx = 600;
constexpr float kShown = 1.7F;  // radii of the goal in its close view
const Eigen::Vector3f kPaper(0.09F, 0.11F, 0.14F);

TrainingPicture picture(const std::string& name, const Camera& camera, SceneView& view) {
    glViewport(0, 0, kWidthPx, kHeightPx);
    glClearColor(kPaper.x(), kPaper.y(), kPaper.z(), 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    ViewFrame frame{};
    frame.width_px = kWidthPx;
    frame.height_px = kHeightPx;
    ViewOptions options;
    options.gradient = false;
    options.plain_ground = kPaper;
    options.force = false;
    view.draw(camera.eye(static_cast<float>(kWidthPx) / kHeightPx), options, frame);
    const Image image = read_pixels(kWidthPx, kHeightPx);
    return {name, png_bytes(image.width_px, image.height_px, image.rgb)};
}

}  // namespace

std::vector<TrainingPicture> training_pictures(SceneView& view, DrillingLayer& layer, float reach_a,
                                               const Eigen::Vector3f& middle_a, float radius_a) {
    GLint bound = 0, viewport[4];
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glGetIntegerv(GL_VIEWPORT, viewport);
    const DrillingLayer::Frame shown = layer.frame;
    layer.frame = {};
    layer.frame.bone_rays = kWidthPx * kHeightPx;
    std::vector<TrainingPicture> pictures;
    {
        const OffscreenTarget target(kWidthPx, kHeightPx);
        target.bind();
        Camera camera;
        camera.frame(reach_a > 0.0F ? reach_a : view.radius_a());
        pictures.push_back(picture("overview", camera, view));
        if (radius_a > 0.0F) {
            camera.approach(middle_a, kShown * radius_a);
            pictures.push_back(picture("goal", camera, view));
        }
    }
    layer.frame = shown;
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    return pictures;
}

}  // namespace tact
