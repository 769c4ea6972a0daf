// The bone on the screen: a sharp picture that is kept from frame to frame, and rays where it does not hold.
//
// Still     only tiles in which bone was drilled are seen through again.
// Moving    a picture of fewer rays, as many as a frame may have, is shown until tiles of the sharp one replace it, from
//           the middle outwards.
// Knob      rays a frame: the governor's level of "gui.volume" is their share of the pixels.
// Depth     that of the surface in each pixel, so everything drawn before and after is hidden or hides as it should.
// Thread    frame thread, context current; the frame buffer and viewport that were bound are bound again.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gui/render/bone_program.hpp"
#include "gui/render/bone_tiles.hpp"
#include "gui/render/scene_content.hpp"

namespace tact {

struct BoneFrame {
    Eigen::Matrix4f eye_from_scene, projection;
    Haze haze;
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport
    std::uint32_t rays_most = 0;
};

class BoneView {
public:
    // All must outlive it; `now` is the bone as it is drilled. Throws StartupError: no room for it.
    BoneView(const SceneContent& content, const BoneVolumeView& now);
    // Its densities in `now` are others than at the last call, or at the start.
    void changed(std::uint32_t brick);
    void draw(const BoneFrame& frame);

    [[nodiscard]] std::uint32_t rays() const { return rays_; }        // of the last draw()
    [[nodiscard]] std::uint32_t rays_max() const { return pixels_; }  // one a pixel of the view
    // Of a ball about the scene's centre that holds the bone as it is, ångström.
    [[nodiscard]] float reach_a() const;
    [[nodiscard]] bool sharp() const { return tiles_.all_good(); }  // nothing is left to draw

private:
    struct Picture {
        GlTexture colour, depth;
        GlFramebuffer frame;
        int width_px = 0, height_px = 0;
        void resize(int width, int height);
        void bind(int width, int height);  // to draw into its lower left part
    };
    void send_changes(const BoneFrame& frame, bool view_is_same);
    [[nodiscard]] PixelBox on_screen(const BoneFrame& frame, const Vec3& low_voxels,
                                     const Vec3& high_voxels) const;
    void draw_coarse(const BoneFrame& frame, std::uint32_t rays_most);
    void draw_tiles(std::span<const std::uint32_t> tiles);
    void show();
    [[nodiscard]] std::array<float, 12> quad(const PixelBox& box) const;

    BoneField field_;
    BoneTextures textures_;
    BoneProgram program_;
    BoneOnScreen on_screen_;
    Eigen::Matrix4f scene_from_voxels_;
    Picture sharp_, coarse_;
    BoneTiles tiles_;
    GlVertexArray array_;
    GlBuffer corners_;
    BoneFrame last_{};
    std::vector<std::uint32_t> changed_;
    bool cells_anew_ = false;
    float coarse_share_x_ = 0.0F,
          coarse_share_y_ = 0.0F;  // of the coarse picture that is in use; 0: none yet
    std::uint32_t rays_ = 0, pixels_ = 0;
};

}  // namespace tact
