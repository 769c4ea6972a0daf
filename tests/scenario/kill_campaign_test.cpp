// kill -9 of the controller and of the visual process, in any order, at random times, many times.
//
// What must hold   the other process continues; both find each other again (a new generation, a heartbeat); a restarted
//                  controller is ready, disarmed, and has had zero force in every cycle.
// Visual process   this program itself, started with --visual: the same link, region and heartbeat as tact-gui without a
//                  window, so that hundreds of kills take seconds. On SIGUSR1 it asks the controller to arm.
// Repeats          the order of events comes from a seed; the times depend on the machine.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "tests/scenario/rig.hpp"

namespace tact::scenario {
namespace {

volatile sig_atomic_t arm_asked = 0;
void on_usr1(int) { arm_asked = 1; }

int be_visual(const std::string& session) {
    signal(SIGUSR1, &on_usr1);
    Visual visual(session);
    while (true) {
        visual.frame();
        if (arm_asked != 0) {
            arm_asked = 0;
            visual.send(CommandKind::arm);
        }
        usleep(5000);
    }
}

struct Count {
    int rounds = 0, controllers = 0, visuals = 0, while_starting = 0, went_on = 0, attached_again = 0,
        came_up_ready = 0;
};

class Campaign {
public:
    Campaign() : watch_(rig_), random_(20261120) {}

    void run(Duration length, int rounds_min) {
        start_controller();
        start_visual();
        check_new_controller();
        check_visual();
        arm();
        const Instant end = Monotonic::now() + length;
        while ((Monotonic::now() < end || count_.rounds < rounds_min) && !::testing::Test::HasFailure()) {
            ++count_.rounds;
            round();
        }
        finish();
    }

private:
    bool coin(int one_in = 2) { return std::uniform_int_distribution<int>(1, one_in)(random_) == 1; }
    void pause(int ms_max) {
        usleep(static_cast<unsigned>(std::uniform_int_distribution<int>(0, ms_max * 1000)(random_)));
    }

    void start_controller() { controller_.emplace(rig_, std::vector<std::string>{}); }
    void start_visual() {
        launch::ChildSettings s;
        s.arguments = {"--visual", rig_.session()};
        visual_.emplace("visual", std::filesystem::read_symlink("/proc/self/exe"), s);
    }
    void kill_controller() {
        kill(controller_->child().pid(), SIGKILL);
        const auto& ending = controller_->child().wait(std::chrono::minutes(1));
        ASSERT_TRUE(ending && ending->by_signal && ending->number == SIGKILL)
            << "the controller had already ended: " << controller_->said();
        ++count_.controllers;
    }
    void kill_visual() {
        kill(visual_->pid(), SIGKILL);
        const auto& ending = visual_->wait(std::chrono::minutes(1));
        ASSERT_TRUE(ending && ending->by_signal && ending->number == SIGKILL)
            << "the visual process had already ended: " << (ending ? ending->text() : "");
        ++count_.visuals;
    }

    void round() {
        const std::uint64_t generation_before = generation_;
        pause(40);
        const bool both = coin(3), controller_dies = both || coin(), visual_dies = both || !controller_dies;
        const bool controller_first = coin();
        if (controller_dies && controller_first) kill_controller();
        if (both) pause(20);
        if (visual_dies) kill_visual();
        if (both) pause(20);
        if (controller_dies && !controller_first) kill_controller();
        if (::testing::Test::HasFatalFailure()) return;
        if (!controller_dies) check_goes_on();

        pause(30);
        if (coin()) restart_visual(visual_dies);
        if (controller_dies) {
            start_controller();
            while (coin(4)) {  // and again before it has started
                pause(40);
                kill_controller();
                ++count_.while_starting;
                if (::testing::Test::HasFatalFailure()) return;
                start_controller();
            }
        }
        restart_visual(visual_dies);
        if (::testing::Test::HasFatalFailure()) return;

        if (controller_dies) {
            check_new_controller();
            EXPECT_NE(generation_, generation_before);
        }
        check_visual();
        if (!controller_dies) {
            EXPECT_EQ(watch_.generation(), generation_before);
            EXPECT_EQ(watch_.state(), RunState::active);
        } else if (!::testing::Test::HasFailure()) {
            arm();
        }
    }

    void restart_visual(bool died) {
        if (!died || !visual_->poll()) return;
        start_visual();
        if (coin(4)) {
            pause(20);
            kill_visual();
            ++count_.while_starting;
            if (!::testing::Test::HasFatalFailure()) start_visual();
        }
    }

    // The visual process died: the controller misses no cycle and keeps the force.
    void check_goes_on() {
        ASSERT_TRUE(watch_.cycles_pass(50)) << controller_->said();
        EXPECT_EQ(watch_.state(), RunState::active) << controller_->said();
        ASSERT_TRUE(until([&] { return watch_.force_n() > 0.0; }));
        EXPECT_FALSE(controller_->child().poll());
        ++count_.went_on;
    }

    // A controller of another generation: it is ready with zero force from its first cycle on, and stays
    // so.
    void check_new_controller() {
        ASSERT_TRUE(watch_.attach(generation_)) << controller_->said();
        generation_ = watch_.generation();
        RingCursor trace;
        ASSERT_TRUE(watch_.cycles_pass(100)) << controller_->said();
        TraceTopic t{};
        int cycles = 0;
        while (watch_.region().trace.next(trace, t)) {
            ++cycles;
            ASSERT_EQ(t.status & 0xFFU, static_cast<unsigned>(RunState::ready)) << "cycle " << t.cycle;
            for (int i = 0; i < 3; ++i) {
                ASSERT_EQ(t.force_world_n[i], 0.0F) << "cycle " << t.cycle;
                ASSERT_EQ(t.torque_world_n_m[i], 0.0F) << "cycle " << t.cycle;
            }
        }
        EXPECT_EQ(trace.missed, 0U);
        EXPECT_GE(cycles, 100);
        EXPECT_EQ(watch_.force_n(), 0.0);
        ++count_.came_up_ready;
    }

    // Attached, and its heartbeat is received.
    void check_visual() {
        ASSERT_TRUE(until([&] {
            const HealthTopic h = watch_.health();
            return h.gui_attached != 0 && h.gui_heartbeat_age_ns >= 0 &&
                   h.gui_heartbeat_age_ns < 500'000'000 && h.gui_vertices == 1000;
        })) << controller_->said();
        EXPECT_FALSE(visual_->poll());
        ++count_.attached_again;
    }

    void arm() {
        ASSERT_TRUE(until([&] {
            // Repeats the request until it is received: the process may not have been attached at the first one.
            if (watch_.state() == RunState::ready) kill(visual_->pid(), SIGUSR1);
            ::usleep(10000);
            return watch_.state() == RunState::active && watch_.force_n() > 0.0;
        })) << controller_->said();
    }

    void finish() {
        std::printf(
            "%d rounds: %d controllers and %d visual processes killed, %d of them while starting; the "
            "controller went on %d "
            "times, came up ready and without force %d times; the two found each other %d times\n",
            count_.rounds, count_.controllers, count_.visuals, count_.while_starting, count_.went_on,
            count_.came_up_ready, count_.attached_again);
        controller_->child().stop();
        const auto& ending = controller_->child().wait(std::chrono::minutes(1));
        EXPECT_TRUE(ending && ending->clean()) << controller_->said();
        visual_.reset();
        EXPECT_FALSE(std::filesystem::exists(rig_.socket()));
        EXPECT_TRUE(rig_.lock_is_free());
        controller_.reset();
        EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child process is left";
        EXPECT_GT(count_.controllers, 0);
        EXPECT_GT(count_.visuals, 0);
        EXPECT_GT(count_.went_on, 0);
    }

    Rig rig_;
    Watch watch_;
    std::mt19937 random_;
    std::optional<Controller> controller_;
    std::optional<launch::Child> visual_;
    std::uint64_t generation_ = 0;
    Count count_;
};

TEST(KillCampaign, if_one_process_dies_the_other_continues_and_a_new_controller_has_no_force_until_armed) {
    const char* const longer = std::getenv("TACT_CAMPAIGN_S");
    const int seconds = longer != nullptr ? std::atoi(longer) : 4;
    Campaign().run(std::chrono::seconds(std::clamp(seconds, 1, 86400)), 8);
}

}  // namespace
}  // namespace tact::scenario

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--visual") == 0) return tact::scenario::be_visual(argv[2]);
    ::testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
