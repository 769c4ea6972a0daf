// The force of a field on a host that stalls: the delay of each second bounds the stiffness, and the force follows
// smoothly.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rt/safety/stages.hpp"
#include "tests/scenario/lockstep.hpp"

namespace tact::stiffness_scenario_test {
namespace {

using std::chrono::milliseconds;

constexpr double kSaysNM = 2000.0;

// Reports its stiffness, but is so weak at the hand that the force lasts for seconds.
class StiffModel final : public ForceModel {
public:
    [[nodiscard]] KnobSpec knob() const noexcept override { return spring_.knob(); }
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept override {
        return spring_.items(fidelity);
    }
    void reset(const ToolState& tool) noexcept override { spring_.reset(tool); }
    [[nodiscard]] ModelStiffness stiffness() const noexcept override { return {.force_n_m = kSaysNM}; }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept override {
        return spring_.step(tool, budget);
    }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return spring_.bodies(); }
    StiffModel() { spring_.stiffness_n_m = 2.0; }

private:
    SpringModel spring_;
};

struct Felt {
    std::vector<double> scale;  // factor on the model's force in each cycle
    std::vector<double> shown_n;
};

class StallScenario : public testing::Test {
protected:
    explicit StallScenario(double damping_n_s_m = 0.0) : loop_(settings(damping_n_s_m)) {
        std::unique_ptr<ForceModel> offered(&stiff_);
        loop_.mailbox_.model.offer(offered);
        loop_.cycles(10);
        static_cast<void>(loop_.mailbox_.model.collect().release());  // owned by the lockstep
        loop_.active();
    }
    static ServoSettings settings(double damping_n_s_m) {
        ServoSettings s;
        s.watchdogs.timing_latches = false;
        s.governor.law = Law::fixed;
        s.damping_n_s_m = damping_n_s_m;
        return s;
    }
    Felt seconds(int n, bool stalls) {
        Felt felt;
        for (int i = 0; i < 1000 * n; ++i) {
            if (stalls && i % 20 == 0) loop_.clock_.advance(milliseconds(4));
            loop_.cycles(1);
            const HandCycle& h = loop_.servo_->state().hand[0];
            felt.scale.push_back(h.field.gain());
            felt.shown_n.push_back(loop_.shown_n());
        }
        return felt;
    }
    static std::size_t until(const Felt& felt, double scale, bool down) {
        std::size_t i = 0;
        while (i < felt.scale.size() && (down ? felt.scale[i] > scale : felt.scale[i] < scale)) ++i;
        return i;
    }
    StiffModel stiff_;
    Lockstep loop_;
};

struct DampedStallScenario : StallScenario {
    DampedStallScenario() : StallScenario(30.0) {}
};

TEST_F(StallScenario, the_force_follows_the_stable_stiffness_smoothly_and_returns_more_slowly) {
    const Felt smooth = seconds(1, false);
    EXPECT_NEAR(smooth.scale.back(), 1.0, 1e-6);  // 3 N s/m over 1.5 ms are 2000 N/m
    const Felt down = seconds(5, true);
    const HealthTopic stalled = loop_.health();
    EXPECT_LT(stalled.stiffness_n_m_max, 800.0F);
    EXPECT_NEAR(down.scale.back(), stalled.stiffness_n_m_max / kSaysNM, 0.01 * down.scale.back());
    const Felt up = seconds(6, false);
    EXPECT_NEAR(up.scale.back(), 1.0, 0.01);

    // Neither steps: an immediate change would remove two thirds in one cycle.
    for (const Felt* felt : {&down, &up})
        for (std::size_t i = 1; i < felt->scale.size(); ++i) {
            ASSERT_LT(std::abs(felt->scale[i] / felt->scale[i - 1] - 1.0), 0.02) << i;
            ASSERT_LT(std::abs(felt->shown_n[i] - felt->shown_n[i - 1]), 0.03 * felt->shown_n[i - 1]) << i;
        }
    EXPECT_EQ(loop_.said(EventCode::slew_limited), 0);

    const double low = down.scale.back();
    const auto took = [&](const Felt& felt, bool falls) {
        const double near = low + 0.1 * (1.0 - low), far = low + 0.9 * (1.0 - low);
        return static_cast<double>(until(felt, falls ? near : far, falls)) -
               static_cast<double>(until(felt, falls ? far : near, falls));
    };
    EXPECT_GT(took(up, false), 1.5 * took(down, true));
}

TEST_F(DampedStallScenario, walls_and_damping_have_their_own_bounds) {
    seconds(5, true);
    const HandCycle& h = loop_.servo_->state().hand[0];
    const HealthTopic t = loop_.health();
    const double delay_s = static_cast<double>(t.delay_p99_ns) * 1e-9;
    EXPECT_EQ(h.walls.gain(), 1.0);  // of 500 N/m
    ASSERT_GT(static_cast<double>(t.stiffness_n_m_max), h.chain.settings().wall_stiffness_n_m);
    const double period_s = 1.0 / loop_.servo_->state().statistics.rate.rate_hz();
    EXPECT_GT(period_s, 1.01e-3);  // a loop that stalls has a longer one
    EXPECT_NEAR(30.0 * h.damper.gain(), stages::damping_max_n_s_m(0.1, period_s, delay_s), 0.05);
    EXPECT_GT(h.damper.gain(), 1.5 * h.field.gain());
}

TEST_F(StallScenario, without_force_the_bound_applies_at_once) {
    loop_.order(CommandKind::disarm);
    loop_.cycles(200);
    ASSERT_EQ(loop_.shown_n(), 0.0);
    for (int i = 0; i < 5000; ++i) {
        if (i % 20 == 0) loop_.clock_.advance(milliseconds(4));
        const double bound = static_cast<double>(loop_.health().stiffness_n_m_max);
        loop_.cycles(1);
        ASSERT_LE(loop_.servo_->state().hand[0].field.gain() * kSaysNM, bound * (1.0 + 1e-6)) << i;
    }
}

}  // namespace
}  // namespace tact::stiffness_scenario_test
