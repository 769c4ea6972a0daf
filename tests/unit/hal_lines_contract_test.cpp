// The contract of safety inputs and outputs: the emulated ones in lockstep, and a pump thread on an emulated board.
#include "tests/contract/lines_contract.hpp"

#include <poll.h>
#include <signal.h>

#include "hal/io/pumped_lines.hpp"
#include "hal/lines_registry.hpp"

namespace tact {
namespace {

class SimRig final : public LinesRig {
public:
    Lines& lines() override { return lines_; }
    void inject(LinesFault fault) override { lines_.inject(fault); }
    std::uint8_t driven() override { return lines_.board().driven(); }
    Instant elapse(Instant now, Duration d) override { return now + d; }

private:
    SimLines lines_;
};

class ThreadRig final : public LinesRig {
public:
    Lines& lines() override { return lines_; }
    void inject(LinesFault fault) override { board_->inject(fault); }
    std::uint8_t driven() override { return board_->driven(); }
    Instant elapse(Instant /*now*/, Duration d) override {
        ::poll(nullptr, 0, static_cast<int>(d / std::chrono::milliseconds(1)));
        return Monotonic::now();
    }

private:
    std::unique_ptr<SimBoard> own_ = std::make_unique<SimBoard>();
    SimBoard* board_ = own_.get();
    PumpedLines lines_{{}, std::move(own_), std::chrono::milliseconds(1)};
};

INSTANTIATE_TEST_SUITE_P(Lockstep, LinesContract,
                         testing::Values(LinesCase{"sim", [] { return std::make_unique<SimRig>(); }}));
INSTANTIATE_TEST_SUITE_P(Thread, LinesContract,
                         testing::Values(LinesCase{"thread", [] { return std::make_unique<ThreadRig>(); }}));

TEST(SimLines, a_contact_that_opened_between_two_samples_stops) {
    SimLines lines;
    static_cast<void>(lines.open());
    Instant now = instant_from_ns(1'000'000'000);
    LinesSample s;
    LinesCommand command;
    const auto tick = [&] {
        now += std::chrono::milliseconds(1);
        lines.write(command, now);
        static_cast<void>(lines.read(s, now));
    };
    for (int i = 0; i < 40; ++i) tick();
    ++command.rearm;
    tick();
    ASSERT_EQ(s.state, LinesState::permitted);
    lines.board().touch(kLineStopB);
    tick();
    EXPECT_EQ(s.state, LinesState::stopped);
    EXPECT_EQ(s.cause, LinesCause::emergency_stop);
}

TEST(SimLines, signals_stop_and_release_the_inputs_of_a_controller) {
    LinesSettings settings;
    settings.driver = "sim";
    const std::unique_ptr<Lines> lines = make_lines(settings);
    static_cast<void>(lines->open());
    Instant now = instant_from_ns(1'000'000'000);
    LinesSample s;
    LinesCommand command;
    const auto ticks = [&](int count) {
        for (int i = 0; i < count; ++i) {
            now += std::chrono::milliseconds(1);
            lines->write(command, now);
            static_cast<void>(lines->read(s, now));
        }
    };
    ticks(40);
    ++command.rearm;
    ticks(1);
    ASSERT_EQ(s.state, LinesState::permitted);
    raise(SIGUSR1);
    ticks(1);
    EXPECT_EQ(s.state, LinesState::stopped);
    EXPECT_EQ(s.cause, LinesCause::emergency_stop);
    ++command.rearm;
    ticks(100);
    EXPECT_EQ(s.state, LinesState::stopped);  // while it is pressed, despite re-arming
    raise(SIGUSR2);
    ticks(100);
    EXPECT_EQ(s.state, LinesState::waiting);
    ++command.rearm;
    ticks(1);
    EXPECT_EQ(s.state, LinesState::permitted);
}

}  // namespace
}  // namespace tact
