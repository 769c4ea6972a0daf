// A body at its fit in a map of 7 A, felt through an arm with the least damping that is documented and a late bus: what
// the bound on the stiffness promises, at the hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "hal/sim/sim_device.hpp"
#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "tests/unit/chain_sample.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact::docking_arm_scenario_test {
namespace {

using std::chrono::milliseconds;

constexpr double kA = chain::kA;

// Arms of 0.05 N s/m exist; alone, without the fingers, such an arm weighs 0.14 kg.
constexpr double kArmDamping = 0.05, kArmTurnDamping = 1e-4;
constexpr auto kLate = milliseconds(1);

// Gives each sample a cycle late, and says so.
class LateArm final : public HapticDevice {
public:
    explicit LateArm(const SimSettings& settings) : arm_(settings) {}
    DeviceInfo open() override { return arm_.open(); }
    IoStatus read(DeviceSample& newest, Instant now) noexcept override {
        DeviceSample fresh;
        const IoStatus status = arm_.read(fresh, now);
        fresh.delay += kLate;
        newest = late_.value_or(fresh);
        late_ = fresh;
        return status;
    }
    IoStatus write(const DeviceCommand& command, Instant now) noexcept override {
        return arm_.write(command, now);
    }
    void relax() noexcept override { arm_.relax(); }

    SimDevice arm_;

private:
    std::optional<DeviceSample> late_;
};

std::unique_ptr<DockingModel> chain_at_its_fit() {
    constexpr double kResolutionM = 7.0 * kA;
    Structure chain = chain::structure(800);
    SceneMeta meta{};
    const DensityGrid grid = chain::map_of(chain, 0.225 * kResolutionM, kResolutionM / 3.5);
    Codebook codebook;
    for (const std::size_t share : {16, 4}) rod::add_level(codebook, chain, share);
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 0.12 / (100.0 * kA);
    for (int a = 0; a < 3; ++a) meta.centre_model_m[a] = chain.home_com_model_m[a];
    meta.map_sigma = chain::sigma_of(grid);
    meta.resolution_m = kResolutionM;
    const LevelMaps maps = make_level_maps(grid, 0.0, meta.map_sigma, kResolutionM,
                                           level_smoothings_m({&chain, 1}, {&codebook, 1}, kResolutionM));
    meta.energy_j_per_sigma =
        docking_gain(maps, {&chain, 1}, {&codebook, 1}, meta.world_per_model).energy_j_per_sigma;
    return std::make_unique<DockingModel>(meta, grid, std::vector<Structure>{chain},
                                          std::vector<Codebook>{codebook}, DockingSettings{});
}

struct Swing {
    double first_uj = 0.0, last_uj = 0.0;  // largest kinetic energy in the first and the last half second
    double gain = 0.0;                     // on the model's force, at the end
    double stiffness_n_m = 0.0, bound_n_m = 0.0;
};

// The arm is held 2 mm beside the fit and let go; nobody holds it then.
Swing let_go(double said_damping_n_s_m, double said_turn_damping_n_m_s_rad) {
    SimSettings sim;
    sim.hand.mass_kg = 0.136;
    sim.hand.damping_n_s_m = kArmDamping;
    sim.hand.damping_n_m_s = kArmTurnDamping;
    const auto model = chain_at_its_fit();
    LateArm arm(sim);
    const HandParts hand{&arm, model.get(), arm.open()};
    ServoSettings settings;
    settings.model_deadline = false;
    settings.dry_cycles = 20;
    settings.visual_paths = kMeshPaths;
    settings.damping_n_s_m = 0.0;
    settings.hand_damping_n_s_m = said_damping_n_s_m;
    settings.hand_turn_damping_n_m_s_rad = said_turn_damping_n_m_s_rad;
    ManualClock clock;
    clock.advance(std::chrono::seconds(100));
    const auto region = std::make_unique<RtRegion>();
    ServoMailbox mailbox;
    Servo servo(ServoParts{clock, {&hand, 1}, *region, mailbox, nullptr}, settings);
    servo.warm_up();
    const Pose fit = arm.arm_.hand_pose();
    arm.arm_.hold(fit.p_m);
    mailbox.orders.push({1, 0.0, static_cast<std::uint32_t>(CommandKind::arm), 0});
    for (int i = 0; i < 1500; ++i) servo.cycle();
    arm.arm_.hold(fit.p_m + Vec3(1.2e-3, -1.0e-3, 1.2e-3));
    for (int i = 0; i < 2000; ++i) servo.cycle();
    EXPECT_EQ(servo.state().run.state, RunState::active);
    arm.arm_.hold(std::nullopt);
    Swing swing;
    constexpr int kCycles = 4000, kHalfSecond = 500;
    for (int i = 0; i < kCycles && !servo.finished(); ++i) {
        const Pose before = arm.arm_.hand_pose();
        servo.cycle();
        const Pose now = arm.arm_.hand_pose();
        const double m_s = 1e3 * (now.p_m - before.p_m).norm(), rad_s = 1e3 * now.q.angularDistance(before.q);
        const double uj = 5e5 * (sim.hand.mass_kg * m_s * m_s + sim.hand.inertia_kg_m2 * rad_s * rad_s);
        if (i < kHalfSecond) swing.first_uj = std::max(swing.first_uj, uj);
        if (i >= kCycles - kHalfSecond) swing.last_uj = std::max(swing.last_uj, uj);
    }
    swing.gain = servo.state().hand[0].field.gain();
    swing.stiffness_n_m = model->stiffness().force_n_m;
    HealthTopic health{};
    static_cast<void>(region->health.read(health));
    swing.bound_n_m = static_cast<double>(health.stiffness_n_m_max);
    return swing;
}

TEST(DockingArm, within_the_bound_no_oscillation_grows) {
    const Swing swing = let_go(kArmDamping, kArmTurnDamping);
    EXPECT_LT(swing.bound_n_m, 34.0);  // 0.05 N s/m over 1.5 ms
    EXPECT_LT(swing.gain * swing.stiffness_n_m, 1.05 * swing.bound_n_m);
    EXPECT_GT(swing.first_uj, 0.5);
    EXPECT_LT(swing.first_uj, 5.0);  // beyond the bound it swings with 100 uJ and more before it is let go
    EXPECT_LE(swing.last_uj, swing.first_uj);
}

// The same arm, said to have four times its damping: why the bound is there.
TEST(DockingArm, beyond_the_bound_it_grows) {
    const Swing swing = let_go(4.0 * kArmDamping, 4.0 * kArmTurnDamping);
    EXPECT_GT(swing.last_uj, 20.0);  // it swings by itself, already while it is held
}

}  // namespace
}  // namespace tact::docking_arm_scenario_test
