// The bone on the screen: a sharp picture that is kept from frame to frame, and rays where it does not hold.
//
// Still     only tiles in which bone was drilled are seen through again.
// Moving    a picture of fewer rays, as many as a frame may have, is shown until tiles of the sharp one replace it, from
//           the middle outwards.
// Knob      rays a frame: the governor's level of "gui.volume" is their share of the pixels.
// Depth     that of the surface in each pixel, so everything drawn before and after is hidden or hides as it should.
// Thread    frame thread, context current; the frame buffer and viewport that were bound are bound again.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gui/drilling/bone_content.hpp"
#include "gui/drilling/bone_program.hpp"
#include "gui/drilling/bone_tiles.hpp"

namespace tact {

struct BoneFrame {
    Eigen::Matrix4f eye_from_scene, projection;
    Haze haze;
    int x_px = 0, y_px = 0, width_px = 1, height_px = 1;  // of the viewport
    std::uint32_t rays_most = 0;
    std::size_t eye = 0;  // which of two: each keeps a picture
    double fill_s = 1e9;  // at most, for what is not in graphics memory yet
};

class BoneView {
public:
    // All must outlive it; `now` is the bone as it is drilled. centre_model_m: origin of the scene frame.
    BoneView(const BoneContent& bone, const Vec3& centre_model_m, const BoneVolumeView& now);
    // Its densities in `now` are others than at the last call, or at the start.
    void changed(std::uint32_t brick);
    // Throws StartupError: no room for it in graphics memory, of which it takes some at each of its first calls.
    void draw(const BoneFrame& frame);

    // Of the last draw() of each eye, together; at the most one a pixel.
    [[nodiscard]] std::uint32_t rays() const { return eye_[0].rays + eye_[1].rays; }
    [[nodiscard]] std::uint32_t rays_max() const { return eye_[0].pixels() + eye_[1].pixels(); }
    // Of a ball about the scene's centre that holds the bone as it is, ångström.
    [[nodiscard]] float reach_a() const;
    [[nodiscard]] bool sharp() const {  // nothing is left to draw
        return textures_.full() && eye_[0].tiles.all_good() && eye_[1].tiles.all_good();
    }
    // Share of the bone that can be seen yet.
    [[nodiscard]] float filled() const { return textures_.filled(field_); }

private:
    struct Picture {
        GlTexture colour, depth;
        GlFramebuffer frame;
        int width_px = 0, height_px = 0;
        void resize(int width, int height);
        void bind(int width, int height);  // to draw into its lower left part
    };
    struct Eyeful {
        Picture sharp, coarse;
        BoneTiles tiles;
        BoneFrame last{};
        std::vector<std::uint32_t> changed;  // bricks, since its last draw()
        float coarse_share_x = 0.0F,
              coarse_share_y = 0.0F;  // of the coarse picture that is in use; 0: none yet
        float filled = -1.0F;         // of the bone, at its last draw()
        std::uint32_t rays = 0;
        [[nodiscard]] std::uint32_t pixels() const {
            return static_cast<std::uint32_t>(sharp.width_px) * static_cast<std::uint32_t>(sharp.height_px);
        }
    };
    void send_changes();
    void mark_changes(Eyeful& eye, const BoneFrame& frame, bool view_is_same) const;
    [[nodiscard]] PixelBox on_screen(const BoneFrame& frame, const Vec3& low_voxels,
                                     const Vec3& high_voxels) const;
    void draw_coarse(Eyeful& eye, std::uint32_t rays_most);
    void draw_tiles(Eyeful& eye, std::span<const std::uint32_t> tiles);
    void show(Eyeful& eye);

    BoneField field_;
    BoneTextures textures_;
    BoneProgram program_;
    BoneOnScreen on_screen_;
    Eigen::Matrix4f scene_from_voxels_;
    std::array<Eyeful, 2> eye_;
    GlVertexArray array_;
    GlBuffer corners_;
    std::vector<std::uint32_t> changed_;
    bool cells_anew_ = false;
};

}  // namespace tact
