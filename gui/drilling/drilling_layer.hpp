// Draws a drilling scene: the bone, the tools, and the particles around the burr.
//
// Thread   frame thread, context current.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gui/drilling/bone_view.hpp"
#include "gui/drilling/drill_tools.hpp"
#include "gui/drilling/microscope.hpp"
#include "gui/drilling/particle_cloud.hpp"
#include "gui/render/scene_layer.hpp"
#include "gui/render/triangle_buffers.hpp"

namespace tact {

class DrillingLayer : public SceneLayer {
public:
    // Content of the next frame.
    struct Frame {
        std::uint32_t bone_rays = 0;  // limit for all eyes together
        double bone_fill_s = 1e9;     // limit to upload bone
        std::span<const DrawnDrillTool> tools;
        const Particles* particles = nullptr;
        Eigen::Vector4f burr_glow = Eigen::Vector4f::Zero();  // colour, and its share of the burr's own
        bool time_particles = false;  // waits for the renderer, see particles_draw_s()
        const WetBone* wet = nullptr;
        // An operating microscope: round field, its own light, and what is far from the focus is blurred.
        bool microscope = false;
        Vec3 focus_model_m = Vec3::Zero();
    };

    // centre_model_m: origin of the scene frame.
    explicit DrillingLayer(const Vec3& centre_model_m) : centre_model_m_(centre_model_m) {}

    Frame frame;
    // Shows this bone as in `now`; both must outlive this. If graphics memory does not suffice, the bone is no longer
    // drawn and bone_error() gives the reason.
    void show_bone(const BoneContent& bone, const BoneVolumeView& now) {
        bone_ = std::make_unique<BoneView>(bone, centre_model_m_, now);
    }
    [[nodiscard]] BoneView* bone() { return bone_.get(); }  // null: none shown
    [[nodiscard]] const BoneView* bone() const { return bone_.get(); }
    [[nodiscard]] const std::string& bone_error() const { return bone_error_; }
    // Drawing time of the last frame with time_particles; meaningful where the CPU renders.
    [[nodiscard]] double particles_draw_s() const { return particles_draw_s_; }

    void draw_structures(const LayerPass& pass) override;
    void draw_volume(const LayerPass& pass) override;
    void draw_fluids(const LayerPass& pass) override;

private:
    void draw_particles(const LayerPass& pass);
    struct ToolInHand {
        DrawnDrillTool shape;
        TriangleBuffers head, rest;
    };

    Vec3 centre_model_m_;
    std::unique_ptr<BoneView> bone_;
    std::string bone_error_;
    std::array<ToolInHand, 2> tool_;          // with the shapes of their meshes
    std::unique_ptr<ParticleCloud> cloud_;    // created with the first particles
    std::unique_ptr<Microscope> microscope_;  // created when first needed
    double particles_draw_s_ = 0.0;
};

}  // namespace tact
