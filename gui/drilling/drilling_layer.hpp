// What is drawn of bone that is drilled: the bone, the tools, and what flies and flows about the burr.
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
#include "gui/drilling/particle_cloud.hpp"
#include "gui/render/scene_layer.hpp"
#include "gui/render/triangle_buffers.hpp"

namespace tact {

class DrillingLayer : public SceneLayer {
public:
    // As it is to be drawn now.
    struct Frame {
        std::uint32_t bone_rays = 0;  // through the bone, at most, of all eyes together
        double bone_fill_s = 1e9;     // at most, for bone that is not in graphics memory yet
        std::span<const DrawnDrillTool> tools;
        const Particles* particles = nullptr;
        bool time_particles = false;  // waits for the renderer, see particles_draw_s()
    };

    // centre_model_m: origin of the scene frame.
    explicit DrillingLayer(const Vec3& centre_model_m) : centre_model_m_(centre_model_m) {}

    Frame frame;
    // From now on this bone as it is in `now`; both must outlive this. Where there turns out to be no room
    // for it, it is drawn no more and bone_error() says so.
    void show_bone(const BoneContent& bone, const BoneVolumeView& now) {
        bone_ = std::make_unique<BoneView>(bone, centre_model_m_, now);
    }
    [[nodiscard]] BoneView* bone() { return bone_.get(); }  // null: none is shown
    [[nodiscard]] const BoneView* bone() const { return bone_.get(); }
    [[nodiscard]] const std::string& bone_error() const { return bone_error_; }
    // Of the last picture that was to time it: where the processor draws, that is its time.
    [[nodiscard]] double particles_draw_s() const { return particles_draw_s_; }

    void draw_structures(const LayerPass& pass) override;
    void draw_volume(const LayerPass& pass) override;
    void draw_fluids(const LayerPass& pass) override;

private:
    struct ToolInHand {
        DrawnDrillTool shape;
        TriangleBuffers mesh;
    };

    Vec3 centre_model_m_;
    std::unique_ptr<BoneView> bone_;
    std::string bone_error_;
    std::array<ToolInHand, 2> tool_;        // with the shapes that their meshes are of
    std::unique_ptr<ParticleCloud> cloud_;  // from the first particles on
    double particles_draw_s_ = 0.0;
};

}  // namespace tact
