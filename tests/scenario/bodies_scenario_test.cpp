// Several bodies in the hand, one after another: the force never steps, identities stay, and a rebuilt model is installed
// without a force step.
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include "hal/sim/sim_device.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "rt/threads/model_builder.hpp"
#include "tests/support/small_scene.hpp"

namespace tact::bodies_scenario_test {
namespace {

// Structure 0: the helix of the small scene. Structure 1: ten times its atoms, at the same positions with small random
// offsets.
std::unique_ptr<DockingModel> two_structures() {
    const std::vector<std::byte> bytes = small_scene().to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "small scene");
    const Structure helix = read_structure(scene, 0);
    Structure big = helix;
    big.name = "big";
    for (auto* v : {&big.x_m, &big.y_m, &big.z_m, &big.mass_fraction}) v->clear();
    SeededRandom random(3);
    const auto tremble = [&] { return static_cast<float>(1e-10 * (random.uniform() - 0.5)); };
    for (std::size_t i = 0; i < 10 * helix.size(); ++i) {
        const std::size_t from = i % helix.size();
        big.x_m.push_back(helix.x_m[from] + tremble());
        big.y_m.push_back(helix.y_m[from] + tremble());
        big.z_m.push_back(helix.z_m[from] + tremble());
        big.mass_fraction.push_back(1.0F / static_cast<float>(10 * helix.size()));
    }
    const Codebook book = read_codebook(scene, 0);
    Codebook finer = book;  // 30, 240 and all 2400: it starts at the middle level
    finer.levels.push_back({helix.x_m, helix.y_m, helix.z_m, helix.mass_fraction, {}, 0.0});
    return std::make_unique<DockingModel>(read_meta(scene), read_force_map_grid(scene),
                                          std::vector<Structure>{helix, big},
                                          std::vector<Codebook>{book, finer}, DockingSettings{});
}

// The loop in lockstep with a wandering hand; it owns its last model.
class Loop {
public:
    explicit Loop(std::unique_ptr<ForceModel> model) : region_(new RtRegion{}), device_(wandering()) {
        clock_.advance(std::chrono::seconds(100));
        hand_ = {&device_, model.release(), device_.open()};
        ServoSettings settings;
        settings.model_deadline = false;
        settings.dry_cycles = 20;
        settings.visual_paths = kMeshPaths;
        servo_.emplace(ServoParts{clock_, {&hand_, 1}, *region_, mailbox_}, settings);
        servo_->warm_up();
        order(CommandKind::arm);
        cycles(1000);
    }
    ~Loop() { delete servo_->state().hand[0].model; }

    // Records the largest change of the force between two cycles, and the smallest force.
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            servo_->cycle();
            const Vec3 now = device_.shown_dev().force_n;
            step_n_max = std::max(step_n_max, (now - before_).norm());
            least_n = std::min(least_n, now.norm());
            before_ = now;
        }
    }
    CommandResult order(CommandKind kind, double value = 0.0, std::uint32_t body = 0, const Pose& pose = {}) {
        ServoOrder o{++sequence_, value, static_cast<std::uint32_t>(kind), 0, body};
        for (int i = 0; i < 3; ++i) o.pos_model_m[i] = pose.p_m[i];
        for (int i = 0; i < 4; ++i) o.quat_model_body_xyzw[i] = pose.q.coeffs()[i];
        mailbox_.orders.push(o);
        least_n = 1e9;
        cycles(1);
        HealthTopic h{};
        return region_->health.read(h) && h.command_sequence == sequence_
                   ? static_cast<CommandResult>(h.command_result)
                   : CommandResult::none;
    }
    [[nodiscard]] BodiesTopic bodies() const {
        BodiesTopic b{};
        EXPECT_TRUE(region_->bodies.read(b));
        return b;
    }
    [[nodiscard]] float level() const { return servo_->governor().level(kForcePathIndex); }
    [[nodiscard]] int said(EventCode code) const {
        RingCursor cursor;
        EventTopic e{};
        int n = 0;
        while (region_->events.next(cursor, e)) n += e.code == static_cast<std::uint16_t>(code);
        return n;
    }
    [[nodiscard]] Pose place(std::uint32_t index) const {
        const BodyPlace b = bodies().body[index];
        return {Vec3(b.pos_model_m), Quat(b.quat_model_body_xyzw)};
    }

    double step_n_max = 0.0, least_n = 1e9;
    ServoMailbox mailbox_;
    std::optional<Servo> servo_;

private:
    static SimSettings wandering() {
        SimSettings s;
        s.hand.script = "wander";
        s.hand.wander_m = 0.01;
        return s;
    }
    ManualClock clock_;
    std::unique_ptr<RtRegion> region_;
    SimDevice device_;
    HandParts hand_{};
    Vec3 before_ = Vec3::Zero();
    std::uint64_t sequence_ = 0;
};

TEST(BodiesScenario, a_hundred_changes_of_the_held_body_cause_no_force_step) {
    Loop loop(two_structures());
    for (const std::uint32_t structure : {0U, 1U, 0U})
        ASSERT_EQ(loop.order(CommandKind::add_body, 0.0, structure, loop.place(0)), CommandResult::done);
    ASSERT_EQ(loop.bodies().count, 5U);
    loop.step_n_max = 0.0;
    int felt = 0;
    SeededRandom random(5);
    std::uint32_t now = 1;
    for (int change = 0; change < 100; ++change) {
        const auto next = 1 + (now + static_cast<std::uint32_t>(3.99 * random.uniform())) % 5;
        now = next;
        const std::uint64_t grips = loop.bodies().grips;
        ASSERT_EQ(loop.order(CommandKind::select_body, 0.0, now), CommandResult::done);
        EXPECT_EQ(loop.bodies().active, now - 1);
        loop.cycles(change % 7 == 0 ? 20 : 500);  // sometimes before the old force is gone
        EXPECT_EQ(loop.bodies().grips, grips + 1);
        if (change % 7 != 0) {
            EXPECT_LT(loop.least_n, 1e-3) << "change " << change;
            HandCycle const& h = loop.servo_->state().hand[0];
            felt += h.step.wrench_world.force_n.norm() > 0.05;
        }
    }
    EXPECT_GT(felt, 50);
    EXPECT_LT(loop.step_n_max, 0.1);
    EXPECT_EQ(loop.said(EventCode::slew_limited), 0);
    EXPECT_EQ(loop.servo_->state().run.state, RunState::active);
}

TEST(BodiesScenario, another_structure_starts_at_a_fitting_level_and_a_copy_keeps_the_level) {
    Loop loop(two_structures());
    ASSERT_EQ(loop.order(CommandKind::add_body, 0.0, 0, loop.place(0)), CommandResult::done);
    EXPECT_EQ(loop.order(CommandKind::set_fidelity_auto), CommandResult::done);
    loop.cycles(3000);
    const float grown = loop.level();
    EXPECT_EQ(loop.order(CommandKind::select_body, 0.0, 3), CommandResult::done);
    EXPECT_FLOAT_EQ(loop.level(), grown);
    EXPECT_EQ(loop.order(CommandKind::select_body, 0.0, 2), CommandResult::done);
    // Ten times as many atoms: the level is chosen anew, among those that fit.
    const ForceModel& model = *loop.servo_->state().hand[0].model;
    const LevelFit& fit = loop.servo_->state().govern.fit;
    EXPECT_EQ(fit.rows().size(), model.knob().steps + 1);
    EXPECT_FLOAT_EQ(loop.level(), fit.rows()[fit.row()].level);
    EXPECT_LE(to_s(model.predict(loop.level()).cost_predicted), 0.7e-3);
    EXPECT_EQ(loop.servo_->state().hand[0].step.load.items, model.items(loop.level()));
}

TEST(BodiesScenario, bodies_keep_their_ids_and_ids_are_never_reused) {
    Loop loop(two_structures());
    ASSERT_EQ(loop.order(CommandKind::add_body, 0.0, 1, loop.place(1)), CommandResult::done);
    ASSERT_EQ(loop.order(CommandKind::remove_body, 0.0, 2), CommandResult::done);
    BodiesTopic b = loop.bodies();
    ASSERT_EQ(b.count, 2U);
    EXPECT_EQ(b.body[0].id, 1U);
    EXPECT_EQ(b.body[1].id, 3U);
    EXPECT_EQ(b.body[1].structure, 1U);
    EXPECT_EQ(b.placements, 2U);
    EXPECT_EQ(b.active, 0U);
    ASSERT_EQ(loop.order(CommandKind::select_body, 0.0, 3), CommandResult::done);
    ASSERT_EQ(loop.order(CommandKind::remove_body, 0.0, 1), CommandResult::done);
    b = loop.bodies();
    ASSERT_EQ(b.count, 1U);
    EXPECT_EQ(b.active, 0U);  // its index changed, and it stays in the hand
    EXPECT_EQ(b.body[0].id, 3U);
    EXPECT_EQ(loop.order(CommandKind::remove_body, 0.0, 3), CommandResult::refused_value);  // the last body
    ASSERT_EQ(loop.order(CommandKind::add_body, 0.0, 0, loop.place(0)), CommandResult::done);
    EXPECT_EQ(loop.bodies().body[1].id, 4U);
    ASSERT_EQ(loop.order(CommandKind::remove_body, 0.0, 3), CommandResult::done);  // the body in the hand
    EXPECT_EQ(loop.bodies().active, kNoBody);
    loop.cycles(300);
    EXPECT_EQ(loop.servo_->state().hand[0].step.wrench_world.force_n, Vec3::Zero());
    for (std::uint32_t i = 1; i < kBodiesMax; ++i)
        EXPECT_EQ(loop.order(CommandKind::add_body, 0.0, 0, loop.place(0)), CommandResult::done);
    EXPECT_EQ(loop.order(CommandKind::add_body, 0.0, 0, loop.place(0)), CommandResult::refused_value);
    EXPECT_EQ(loop.order(CommandKind::select_body, 0.0, 99), CommandResult::refused_value);
    EXPECT_EQ(loop.order(CommandKind::add_body, 0.0, 7, loop.place(0)), CommandResult::refused_value);
}

TEST(BodiesScenario, a_fixed_body_neither_moves_nor_pushes_until_it_is_freed) {
    Loop loop(two_structures());
    ASSERT_EQ(loop.order(CommandKind::fix_body, 1.0, 1), CommandResult::done);
    EXPECT_EQ(loop.bodies().body[0].flags, kBodyFixed);
    const Pose fixed = loop.place(0);
    loop.cycles(600);
    EXPECT_EQ(loop.place(0).p_m, fixed.p_m);
    EXPECT_EQ(loop.servo_->state().hand[0].step.wrench_world.force_n, Vec3::Zero());
    const std::uint64_t grips = loop.bodies().grips;
    ASSERT_EQ(loop.order(CommandKind::fix_body, 0.0, 1), CommandResult::done);
    EXPECT_EQ(loop.bodies().grips, grips + 1);
    EXPECT_LT((loop.place(0).p_m - fixed.p_m).norm(), 1e-11);
    loop.cycles(600);
    EXPECT_GT((loop.place(0).p_m - fixed.p_m).norm(), 1e-11);
    EXPECT_EQ(loop.said(EventCode::slew_limited), 0);
}

TEST(BodiesScenario, a_placed_body_is_at_its_pose_and_the_hand_moves_it_from_there) {
    Loop loop(two_structures());
    Pose there = loop.place(0);
    there.p_m += Vec3(3e-10, -2e-10, 1e-10);
    there.q = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX())) * there.q;
    ASSERT_EQ(loop.order(CommandKind::place_body, 0.0, 1, there), CommandResult::done);
    EXPECT_LT((loop.place(0).p_m - there.p_m).norm(), 1e-12);
    EXPECT_LT(loop.place(0).q.angularDistance(there.q), 1e-6);
    loop.cycles(600);
    EXPECT_LT(loop.least_n, 1e-3);
    EXPECT_LT(loop.step_n_max, 0.1);
    ASSERT_EQ(loop.order(CommandKind::place_body, 0.0, 2, there), CommandResult::done);
    EXPECT_EQ(loop.place(1).p_m, there.p_m);
    EXPECT_GT(loop.servo_->state().hand[0].step.wrench_world.force_n.norm(), 1e-3);  // continues
    EXPECT_EQ(loop.bodies().placements, 2U);
}

// --- rebuilt models ---

// A model with options that need a rebuild: one that succeeds, and one that fails.
class BuiltAside final : public ForceModel {
public:
    static constexpr std::uint32_t kFails = kDockingLaplacian;
    [[nodiscard]] KnobSpec knob() const noexcept override { return {.path = "test", .haptic = true}; }
    [[nodiscard]] std::uint32_t items(float) const noexcept override { return 1; }
    void reset(const ToolState&) noexcept override {}
    StepResult step(const ToolState&, const Budget&) noexcept override { return {}; }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return bodies_; }
    bool order(const ModelOrder& o) noexcept override {
        if (o.kind == ModelOrder::Kind::setting) {
            const auto command = static_cast<CommandKind>(o.command);
            const std::uint32_t option = command == CommandKind::set_clash         ? kDockingClash
                                         : command == CommandKind::set_subtraction ? kDockingSubtraction
                                                                                   : kDockingLaplacian;
            bodies_.options_asked = o.on ? bodies_.options_asked | option : bodies_.options_asked & ~option;
        }
        if (o.kind == ModelOrder::Kind::place) bodies_.T_model_body[0] = o.T_model_body;
        return true;
    }
    [[nodiscard]] bool stale() const noexcept override { return bodies_.options != bodies_.options_asked; }
    [[nodiscard]] std::unique_ptr<ForceModel> rebuild(const ModelBodies& bodies) const override {
        if ((bodies.options_asked & kFails) != 0) throw std::runtime_error("unknown density");
        auto made = std::make_unique<BuiltAside>();
        made->bodies_.options = bodies.options_asked;
        return made;
    }
    bool adopt(const ForceModel& old) noexcept override {
        const std::uint32_t built = bodies_.options;
        bodies_ = static_cast<const BuiltAside&>(old).bodies_;
        bodies_.options = built;
        return true;
    }
    void give_up() noexcept override { bodies_.options_asked = bodies_.options; }
    BuiltAside() {
        bodies_.count = 1;
        bodies_.id[0] = 1;
    }

private:
    ModelBodies bodies_;
};

// Runs cycles and the builder's poll until the rebuild is complete.
void settle(Loop& loop, ModelBuilder& builder) {
    for (int i = 0; i < 60000; ++i) {
        builder.poll();
        loop.mailbox_.model.collect().reset();
        loop.cycles(2);
        if (loop.bodies().building == 0) return;
        ::poll(nullptr, 0, 1);
    }
    FAIL() << "the rebuild did not end";
}

TEST(BodiesScenario, a_change_beyond_constant_time_is_rebuilt_and_continues_from_the_current_state) {
    Loop loop(std::make_unique<BuiltAside>());
    ModelBuilder builder(loop.mailbox_, gettid());
    ASSERT_EQ(loop.order(CommandKind::set_subtraction, 1.0), CommandResult::done);
    EXPECT_EQ(loop.bodies().building, 1U);
    EXPECT_EQ(loop.bodies().options, 0U);
    const Pose there{Vec3(1e-9, 2e-9, 3e-9), Quat::Identity()};  // during the rebuild
    ASSERT_EQ(loop.order(CommandKind::place_body, 0.0, 1, there), CommandResult::done);
    settle(loop, builder);
    EXPECT_EQ(loop.bodies().options, static_cast<std::uint32_t>(kDockingSubtraction));
    EXPECT_EQ(loop.place(0).p_m, there.p_m);
    EXPECT_EQ(loop.said(EventCode::model_swapped), 1);
    // Orders during a rebuild apply to the next one.
    ASSERT_EQ(loop.order(CommandKind::set_subtraction, 0.0), CommandResult::done);
    ASSERT_EQ(loop.order(CommandKind::set_clash, 1.0), CommandResult::done);
    settle(loop, builder);
    EXPECT_EQ(loop.bodies().options, static_cast<std::uint32_t>(kDockingClash));
    EXPECT_EQ(loop.said(EventCode::model_swapped), 3);
}

TEST(BodiesScenario, a_failed_rebuild_is_given_up_and_the_old_model_continues) {
    Loop loop(std::make_unique<BuiltAside>());
    ModelBuilder builder(loop.mailbox_, gettid());
    ASSERT_EQ(loop.order(CommandKind::set_laplacian, 1.0), CommandResult::done);
    EXPECT_EQ(loop.bodies().building, 1U);
    settle(loop, builder);
    EXPECT_EQ(loop.bodies().options, 0U);
    EXPECT_EQ(loop.said(EventCode::model_swapped), 0);
    ASSERT_EQ(loop.order(CommandKind::set_subtraction, 1.0), CommandResult::done);
    settle(loop, builder);
    EXPECT_EQ(loop.bodies().options, static_cast<std::uint32_t>(kDockingSubtraction));
}

TEST(BodiesScenario, a_builder_can_end_at_any_time) {
    for (int cycles = 0; cycles < 4; ++cycles) {
        Loop loop(std::make_unique<BuiltAside>());
        ModelBuilder builder(loop.mailbox_, gettid());
        static_cast<void>(loop.order(CommandKind::set_subtraction, 1.0));
        for (int i = 0; i < cycles; ++i) builder.poll();
    }
}

}  // namespace
}  // namespace tact::bodies_scenario_test
