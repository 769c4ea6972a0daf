// The supervisor on real threads: a stopped servo loses the enable line during the stop, detects this once it runs again,
// and only a person restores the line. For the duration of the drop see tests/bench/supervisor_bench.
#include <gtest/gtest.h>

#include "tests/support/real_loop.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact {
namespace {

using test::wait_for;

// Longer than pauses on a busy host; a longer pause only causes one more drop.
constexpr Duration kSilence = std::chrono::milliseconds(500);

class SupervisorScenario : public testing::TestWithParam<Stand> {};

TEST_P(SupervisorScenario, a_stopped_servo_loses_the_enable_line_until_a_person_resets_and_arms) {
    RealLoop loop(kSilence);
    const auto cycles_pass = [&](std::uint64_t n) {
        const std::uint64_t begin = loop.health().cycle;
        return wait_for([&] { return loop.health().cycle >= begin + n; });
    };
    std::uint64_t before = 0;
    ASSERT_TRUE(wait_for([&] {
        before = loop.drops();
        return loop.brought_up();
    }));
    // The servo is not involved: it is stopped until it is released below.
    loop.stand(GetParam());
    ASSERT_TRUE(wait_for([&] { return loop.drops() > before && !loop.enabled(); }));
    EXPECT_EQ(loop.drops(), before + 1);
    EXPECT_TRUE(wait_for([&] { return loop.lines().drops == loop.drops(); }));

    // It runs again: fault, cause and counter are reported, and the line stays low.
    loop.stand(Stand::none);
    ASSERT_TRUE(wait_for([&] { return loop.state() == RunState::fault; }));
    EXPECT_EQ(loop.health().reason, static_cast<std::uint8_t>(RunReason::supervisor));
    FaultSnapshot snapshot{};
    ASSERT_TRUE(loop.mailbox().fault.read(snapshot));
    EXPECT_EQ(snapshot.reason, static_cast<std::uint64_t>(RunReason::supervisor));
    RingCursor cursor;
    EventTopic event{};
    double said = -1.0;
    while (loop.region().events.next(cursor, event))
        if (event.code == static_cast<std::uint16_t>(EventCode::fault_latched)) said = event.a;
    EXPECT_EQ(said, static_cast<double>(RunReason::supervisor));
    ASSERT_TRUE(cycles_pass(500));
    EXPECT_FALSE(loop.enabled());
    const std::uint64_t refused = loop.order(CommandKind::arm);
    ASSERT_TRUE(wait_for([&] { return loop.health().command_sequence == refused; }));
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_state));
    ASSERT_TRUE(cycles_pass(100));
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_FALSE(loop.enabled());
    EXPECT_EQ(loop.drops(), before + 1);

    loop.order(CommandKind::reset_fault);
    ASSERT_TRUE(wait_for([&] { return loop.state() == RunState::ready; }));
    ASSERT_TRUE(cycles_pass(100));
    EXPECT_FALSE(loop.enabled());
    ASSERT_TRUE(wait_for([&] { return loop.brought_up(); }));
}

INSTANTIATE_TEST_SUITE_P(Servo, SupervisorScenario, testing::Values(Stand::asleep, Stand::spinning),
                         [](const auto& tested) {
                             return tested.param == Stand::asleep ? "asleep" : "spinning";
                         });

}  // namespace
}  // namespace tact
