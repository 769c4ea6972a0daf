// The bone on the screen: a sharp image kept from frame to frame, and new rays where it is invalid.
//
// Still     rays are cast again only in tiles whose bone was drilled.
// Moving    a coarser image, with as many rays as a frame allows, is shown until sharp tiles replace it from the
//           centre outwards.
// Level     rays per frame: the governor's level of "gui.volume" is a fraction of the pixels.
// Depth     that of the surface in each pixel, so bone and everything else hide each other correctly.
// Thread    frame thread, context current; the framebuffer and viewport that were bound are bound again.
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
    std::size_t eye = 0;  // index; each keeps an image
    double fill_s = 1e9;  // at most, to upload bone
    bool coaxial_light = false;
};

class BoneView {
public:
    // All arguments must outlive it; `now` is the bone as drilled. centre_model_m: origin of the scene frame.
    BoneView(const BoneContent& bone, const Vec3& centre_model_m, const BoneVolumeView& now);
    // Reports that the brick's densities in `now` changed since the last call, or since the start. grown: some rose.
    void changed(std::uint32_t brick, bool grown = false);
    // Reports that the cells of wet.changed() changed.
    void wetted(const WetBone& wet);
    // Throws StartupError if graphics memory, allocated step by step in the first calls, does not suffice.
    void draw(const BoneFrame& frame);

    // Total of the last draw() of each eye; at most one per pixel.
    [[nodiscard]] std::uint32_t rays() const { return eye_[0].rays + eye_[1].rays; }
    [[nodiscard]] std::uint32_t rays_max() const { return eye_[0].pixels() + eye_[1].pixels(); }
    // Radius of a ball about the scene's centre that contains the current bone, ångström.
    [[nodiscard]] float reach_a() const;
    [[nodiscard]] bool sharp() const {  // nothing left to draw
        return textures_.full() && eye_[0].tiles.all_good() && eye_[1].tiles.all_good();
    }
    // Fraction of the bone that is visible so far.
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
        std::vector<std::uint32_t> changed, wetted;  // bricks, since this eye's last draw()
        float coarse_share_x = 0.0F,
              coarse_share_y = 0.0F;  // part of the coarse image in use; 0: none yet
        float filled = -1.0F;         // fraction of the bone, at the last draw()
        std::uint32_t rays = 0;
        [[nodiscard]] std::uint32_t pixels() const {
            return static_cast<std::uint32_t>(sharp.width_px) * static_cast<std::uint32_t>(sharp.height_px);
        }
    };
    void send_changes();
    void mark_changes(Eyeful& eye, bool view_is_same) const;
    void mark(Eyeful& eye, std::span<const std::uint32_t> bricks, double reach_voxels) const;
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
};

}  // namespace tact
