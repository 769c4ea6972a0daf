// Docking: atomic structures felt in an electron density map.
//
// Energy    U = -k_E * sum_i w_i rho(x_i), k_E in joules per sigma, w_i mass fractions, rho in sigma. Force
//           and torque are its derivatives, so the field is conservative at every level of the knob.
// Grip      the tool moves the body's centre of mass, the tool's rotation turns the body about it; so the
//           wrench at the tool's origin is force and torque about the centre of mass. The grip is taken at
//           reset() and when the clutch (button bit 0) is released; with the clutch held the body stays and
//           the tool moves alone.
// Knob      "docking.force": codebook levels from the smallest to all atoms, blended in between.
// Frames    wrench in world, bodies in model. SceneMeta maps one to the other.
// Thread    constructed anywhere (may throw StartupError); then one thread, normally the servo. No
// allocation. Fails by  out_of_range: a pose that is not finite gives no force and leaves the bodies where
//           they are; out_of_time: the wrench is that of a smaller level.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ipc/assets/density_map.hpp"
#include "ipc/assets/scene_file.hpp"
#include "ipc/assets/scene_meta.hpp"
#include "ipc/assets/structure.hpp"
#include "rt/force/docking/point_set.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

struct DockingSettings {
    // Where body 0 starts, away from its home: a distance in a random direction, an angle about a random
    // axis.
    double start_offset_m = 0.0;
    double start_rotation_rad = 0.0;
    std::uint64_t seed = 1;
    double force_scale = 1.0;  // times the scene's gain
};

class DockingModel final : public ForceModel {
public:
    // codebooks: one for each structure, levels rising in size and smaller than its atoms.
    DockingModel(const SceneMeta& meta, const DensityGrid& grid, const std::vector<Structure>& structures,
                 const std::vector<Codebook>& codebooks, const DockingSettings& settings);

    [[nodiscard]] KnobSpec knob() const noexcept override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept override;
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override { return bodies_; }

    // The wrench on the active body, were it at this place: what step() shows once its ramp is over.
    [[nodiscard]] StepResult evaluate(const Pose& T_model_body, const Budget& budget) const noexcept TACT_RT;
    // Cost and error of a level before it is computed.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT;

    [[nodiscard]] const DensityMap& map() const { return map_; }
    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] double energy_j_per_sigma() const { return energy_j_per_sigma_; }
    [[nodiscard]] const Pose& home() const { return bodies_home_.T_model_body[bodies_.active]; }

    static constexpr const char* kKnobPath = "docking.force";
    // Steps over which the force fades in after a grip, and out when the clutch is pressed.
    static constexpr int kRampSteps = 256;

private:
    struct Level {
        PointSet points;
        Duration cost{0};      // measured at construction
        double error_n = 0.0;  // estimated bound of the force difference to all atoms, see calibrate()
    };
    struct Body {
        std::vector<Level> levels;  // the last is all atoms
    };
    struct Plan {  // levels to be summed for a fidelity: (1 - blend) * lower + blend * upper
        std::size_t lower, upper;
        double blend;
    };

    void add_body(const Structure& structure, const Codebook& codebook);
    void calibrate(Body& body, const Pose& home);
    [[nodiscard]] Plan plan(const Body& body, float fidelity) const noexcept;
    [[nodiscard]] bool sum_level(const Level& level, const Pose& T_model_body, Instant deadline,
                                 DensitySums& sums) const noexcept;
    [[nodiscard]] Wrench wrench(const DensitySums& sums) const noexcept;
    void grip(const Pose& T_world_tool) noexcept;

    SceneMeta meta_;
    double energy_j_per_sigma_;
    DensityMap map_;
    std::vector<Body> parts_;
    ModelBodies bodies_, bodies_home_;
    // The grip: translation from tool to centre of mass (world axes, it does not turn with the tool), and
    // rotation.
    Vec3 com_from_tool_world_m_ = Vec3::Zero();
    Quat q_tool_body_ = Quat::Identity();
    int ramp_ = 0;          // 0: no force, kRampSteps: all of it
    bool clutched_ = true;  // until the first good step, which takes the grip where the tool then is
};

// Reads the scene's map, structures and codebooks.
std::unique_ptr<DockingModel> load_docking_model(const SceneFile& scene, const DockingSettings& settings);

}  // namespace tact
