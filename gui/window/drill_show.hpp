// All that is shown of bone that is drilled: the bone as it is now, what flies and flows about the burr, the tools,
// distances and a trainee's report.
//
// Frame     use() when a scene came, meet() when a controller came, leave() when it went; each frame follow(), move(),
//           prepare() before the view is drawn, drawn() after it and ended() at the end
// Start     a large volume goes into graphics memory over many pictures; a share of it is seen meanwhile, and said
// Levels    "gui.volume" and "gui.particles" stay as the controller last told. Where the processor draws, no more than fit
//           a picture by the clock; of particles not where a person fixed the level.
// Thread    frame thread
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "gui/drilling/bone_controller.hpp"
#include "gui/drilling/drill_controller.hpp"
#include "gui/drilling/drill_hands.hpp"
#include "gui/drilling/drill_start.hpp"
#include "gui/drilling/particle_pace.hpp"
#include "gui/drilling/ray_pace.hpp"
#include "gui/drilling/site_effects.hpp"
#include "gui/link/controller.hpp"
#include "gui/window/scene_view.hpp"
#include "ipc/topics/load.hpp"

namespace tact {

class DrillShow {
public:
    explicit DrillShow(bool software) : software_(software) {}

    // start: made for the same content. particles: there are always so many over the bone (Site::keep()). Throws StartupError
    // where the bone cannot be drawn.
    void use(const std::shared_ptr<const SceneContent>& content, const Controller& controller,
             DrillStart start, SceneView& view, std::uint32_t particles);
    void meet(const Controller& controller);
    void leave() { bone_.leave(); }
    void follow(Controller& controller, DashboardState& dashboard, DrillingState& state);
    void move(const Controller& controller, double frame_s, const Vec3& eye_model_m);
    // sharp: all rays, whatever they cost.
    void prepare(const Controller& controller, SceneView& view, bool sharp, ViewFrame& frame);
    void drawn(SceneView& view, DashboardState& state);
    void ended(SceneView& view, double work_s);
    void add_to(LoadTopic& load, SceneView& view) const;
    // Empty path, or a scene without bone: no report. Throws StartupError.
    void save(const Controller& controller, const std::string& report) const;

private:
    [[nodiscard]] std::uint32_t rays_most(const Controller& controller, const ViewFrame& frame, bool sharp);
    [[nodiscard]] float particles_share(const Controller& controller) const;

    const bool software_;
    std::shared_ptr<const SceneContent> content_;
    BoneController bone_;
    std::unique_ptr<SiteEffects> site_;  // goes before the bone that it reads
    ParticlePace particle_pace_;
    RayPace ray_pace_;
    float particles_level_ = 1.0F;
    double rays_share_ = 1.0;  // of the pixels
    DrillController desk_;
    DrillHands hands_;
};

}  // namespace tact
