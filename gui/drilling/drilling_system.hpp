// Drilling in the window: the current bone, particles around the burr, tools, distances, and the trainee's report.
//
// Start     a large volume is uploaded over many frames; meanwhile a fraction is visible, and shown as text
// Levels    "gui.volume" and "gui.particles" keep the controller's newest values. A software renderer limits them to
//           what fits a frame by the clock, except for particles at a level that the user fixed.
// Thread    frame thread
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gui/drilling/bone_controller.hpp"
#include "gui/drilling/burr_tray.hpp"
#include "gui/drilling/drill_controller.hpp"
#include "gui/drilling/drill_hands.hpp"
#include "gui/drilling/drill_start.hpp"
#include "gui/drilling/drilling_layer.hpp"
#include "gui/drilling/drilling_panel.hpp"
#include "gui/drilling/particle_pace.hpp"
#include "gui/drilling/ray_pace.hpp"
#include "gui/drilling/site_effects.hpp"
#include "gui/drilling/sound/sound_device.hpp"
#include "gui/drilling/training/training.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

struct DrillingOptions {
    std::string report;           // JSON, at the end; empty: none
    std::uint32_t particles = 0;  // always this many over the bone (SiteEffects::keep()); 0: off
    bool near_burr = false;       // moves the view to the burr once it is in bone
    bool mute = false;            // no sound
    TrainingOptions training;
};

class DrillingSystem : public SceneSystem {
public:
    explicit DrillingSystem(DrillingOptions options) : options_(std::move(options)) {}

    [[nodiscard]] SystemPanels& panels() override { return panels_; }
    void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
             SceneView& view, const SystemContext& context) override;
    void close() override;
    [[nodiscard]] float home_reach_a() const override { return reach_a_; }
    void attach(const SystemContext& context) override;
    void detach() override { bone_.leave(); }
    void follow(const SystemContext& context) override;
    bool perform(KeyAction what, std::size_t place, const SystemContext& context) override;
    [[nodiscard]] std::optional<Vec3> place_along(const Vec3& from_m, const Vec3& way) const override;
    void move(double frame_s, const Vec3& eye_model_m, const SystemContext& context) override;
    [[nodiscard]] bool second_hand_is_pen() const override { return false; }
    void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) override;
    void drawn(const SystemContext& context) override;
    void ended(double work_s) override;
    void add_to(LoadTopic& load) const override;
    void finish(const SystemContext& context) override;

private:
    [[nodiscard]] std::uint32_t rays_most(const ViewFrame& frame, bool sharp, const SystemContext& context);
    [[nodiscard]] float particles_share(const SystemContext& context) const;
    void approach_burr(const SystemContext& context) const;
    [[nodiscard]] Vec3 focus(std::int64_t now_ns, const SystemContext& context);
    void sound(const SystemContext& context);
    void begin_training(const BoneContent& bone);
    void train(const SystemContext& context);
    [[nodiscard]] std::vector<TrainingPicture> pictures();
    [[nodiscard]] std::optional<BurrVisibility> visibility() const;
    // Disarms and follows the bone until it rests, so that the report has all that was drilled.
    void let_training_rest(const SystemContext& context);
    [[nodiscard]] nlohmann::json end_training();
    [[nodiscard]] TrayBurr in_hand() const;
    void take_burr(const TrayBurr& burr, const SystemContext& context) const;

    const DrillingOptions options_;
    DrillingPanels panels_;
    std::shared_ptr<const SceneContent> content_;
    SceneView* view_ = nullptr;
    BoneController bone_;
    std::unique_ptr<SiteEffects> site_;     // destroyed before the bone that it reads
    std::unique_ptr<DrillingLayer> layer_;  // likewise
    ParticlePace particle_pace_;
    RayPace ray_pace_;
    float particles_level_ = 1.0F;
    double rays_share_ = 1.0;  // of the pixels
    float reach_a_ = 0.0F;     // radius of the bone when loaded; 0: none drawn
    bool near_burr_wanted_ = options_.near_burr;
    std::optional<Vec3> focus_model_m_;
    std::int64_t focus_ns_ = 0;
    DrillController controller_;
    DrillHands hands_;
    DrillVoice voice_;
    std::unique_ptr<SoundDevice> sound_;  // plays the voice; null: muted, or no scene
    std::uint64_t heard_levels_ = 0;      // removed by the burr
    std::int64_t heard_ns_ = 0;
    double load_ = 0.0;
    std::unique_ptr<Training> training_;  // null: none
    std::vector<TrainingPicture> before_;
};

}  // namespace tact
