// The loop's records of every cycle for recordings: complete, in order, with the inputs as received.
#include <gtest/gtest.h>

#include "ipc/recorder/drain.hpp"
#include "ipc/recorder/flight.hpp"
#include "tests/scenario/lockstep.hpp"

namespace tact::record_scenario_test {
namespace {

using record::Batch;
using record::Drain;

SimSettings wandering() {
    SimSettings s;
    s.hand.script = "wander";
    return s;
}

TEST(RecordScenario, every_cycle_is_recorded_with_its_hand_including_dry_ones) {
    Lockstep loop({}, wandering());
    Drain drain(*loop.region_);
    loop.active();
    Batch batch;
    drain.take(batch, 0);
    ASSERT_EQ(batch.cycles.size(), 620U);
    ASSERT_EQ(batch.hand[0].size(), 620U);
    EXPECT_TRUE(batch.hand[1].empty());
    EXPECT_EQ(drain.dropped(), 0U);
    for (std::size_t i = 0; i < batch.cycles.size(); ++i) {
        EXPECT_EQ(batch.cycles[i].step, i + 1);
        EXPECT_EQ(batch.hand[0][i].step, i + 1);
        EXPECT_EQ((batch.cycles[i].flags & kCycleDry) != 0, i < 20);
        EXPECT_EQ(batch.cycles[i].cycle, i < 20 ? i + 1 : i - 19);
    }
    StartTopic start{};
    ASSERT_TRUE(loop.region_->start.read(start));
    EXPECT_EQ(start.dry_steps, 20U);
    EXPECT_EQ(start.hands, 1U);
    EXPECT_EQ(start.period_ns, 1'000'000);
    EXPECT_GT(start.device[0].force_n_max, 1.0);
}

TEST(RecordScenario, a_step_holds_the_device_sample_and_the_command_sent) {
    Lockstep loop({}, wandering());
    loop.active();
    loop.cycles(1);
    Drain drain(*loop.region_);
    Batch batch;
    drain.take(batch, 0);
    const HandTopic& h = batch.hand[0].back();
    const HandCycle& c = loop.servo_->state().hand[0];
    const ToolTopic tool = loop.tool();
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(h.pos_dev_m[i], c.sample.T_dev_tool.p_m[i]);
        EXPECT_EQ(h.velocity_dev_m_s[i], c.sample.twist_dev.linear_m_s[i]);
        EXPECT_EQ(h.force_world_n[i], tool.force_world_n[i]);
        EXPECT_EQ(h.force_model_world_n[i], tool.force_model_n[i]);
    }
    EXPECT_EQ(h.taken_at_ns, tool.taken_at_ns);
    EXPECT_EQ(h.hand_present, 1);
    EXPECT_EQ(h.deadline_check, 0U);
    EXPECT_EQ(batch.cycles.back().run_state, static_cast<std::uint8_t>(RunState::active));
    EXPECT_EQ(batch.cycles.back().timestamps, 4);  // wake-up, before and after the model, end
}

TEST(RecordScenario, orders_and_reports_are_recorded_with_the_step_that_read_them) {
    Lockstep loop;
    loop.cycles(10);
    loop.order(CommandKind::set_goal_hz, 500.0);
    loop.cycles(5);
    loop.mailbox_.housekeeping.publish(gui_at(loop.clock_.now()));
    loop.cycles(5);
    Drain drain(*loop.region_);
    Batch batch;
    drain.take(batch, 0);
    ASSERT_EQ(batch.mailbox.size(), 1U);
    EXPECT_EQ(batch.mailbox[0].step, 20U + 11U);
    EXPECT_EQ(batch.mailbox[0].kind, static_cast<std::uint32_t>(MailboxKind::order));
    EXPECT_EQ(batch.mailbox[0].order.kind, static_cast<std::uint32_t>(CommandKind::set_goal_hz));
    EXPECT_EQ(batch.mailbox[0].order.value, 500.0);
    ASSERT_EQ(batch.reports.size(), 1U);
    EXPECT_EQ(batch.reports[0].step, 20U + 16U);
    EXPECT_EQ(batch.reports[0].said.gui_generation, 5U);
    EXPECT_FALSE(batch.health.empty());
    EXPECT_FALSE(batch.levels.empty());
}

TEST(RecordScenario, a_lapped_reader_reports_the_number_of_missed_records) {
    Lockstep loop;
    Drain drain(*loop.region_);
    Batch batch;
    const int capacity = static_cast<int>(decltype(RtRegion::cycles)::kCapacity);
    loop.cycles(capacity + 100);
    drain.take(batch, 77);
    ASSERT_FALSE(batch.cycles.empty());
    ASSERT_FALSE(batch.drops.empty());
    const std::uint64_t lost = batch.cycles.front().step - 1;
    EXPECT_GE(lost, 100U);
    EXPECT_EQ(batch.drops[0].ring, static_cast<std::uint32_t>(RecordRing::cycles));
    EXPECT_EQ(batch.drops[0].records, lost);
    EXPECT_EQ(batch.drops[0].noticed_at_ns, 77);
    EXPECT_EQ(batch.hand[0].front().step, batch.cycles.front().step);
    EXPECT_EQ(batch.cycles.back().step, static_cast<std::uint64_t>(capacity) + 120U);
    EXPECT_EQ(batch.cycles.size() + lost, static_cast<std::size_t>(capacity) + 120U);
}

TEST(RecordScenario, a_late_reader_begins_with_the_oldest_record_and_counts_no_drops) {
    Lockstep loop;
    loop.cycles(static_cast<int>(decltype(RtRegion::cycles)::kCapacity) + 100);
    Drain drain(*loop.region_);
    Batch batch;
    drain.take(batch, 0);
    EXPECT_EQ(drain.dropped(), 0U);
    EXPECT_TRUE(batch.drops.empty());
    ASSERT_GT(batch.cycles.size(), 16000U);
    EXPECT_EQ(batch.cycles.front().step, batch.hand[0].front().step);
}

TEST(FlightTape, keeps_the_last_seconds_within_its_byte_limit) {
    Lockstep loop;
    Drain drain(*loop.region_);
    record::FlightTape tape(std::chrono::seconds(2), std::size_t{64} << 20U);
    record::FlightTape small(std::chrono::seconds(2), 200'000);
    for (int i = 0; i < 40; ++i) {
        loop.cycles(250);
        Batch batch;
        drain.take(batch, 0);
        small.add(Batch(batch));
        tape.add(std::move(batch));
        EXPECT_LE(small.bytes(), 200'000U);
        EXPECT_LE(tape.length_s(), 2.3);
    }
    EXPECT_GE(tape.length_s(), 1.9);
    EXPECT_EQ(tape.batches().back().cycles.back().step, 40U * 250U + 20U);
    EXPECT_EQ(tape.first_step(), tape.batches().front().cycles.front().step);
    EXPECT_LT(small.length_s(), 0.6);
    EXPECT_GT(small.first_step(), tape.first_step());
}

TEST(FlightTape, only_a_fault_an_overrun_and_a_mark_are_causes) {
    Lockstep loop({}, wandering());
    Drain drain(*loop.region_);
    const auto cause_of = [&] {
        Batch batch;
        drain.take(batch, 0);
        return record::reason_in(batch).cause;
    };
    loop.active();
    loop.order(CommandKind::set_goal_hz, 900.0);
    loop.cycles(300);
    EXPECT_EQ(cause_of(), record::FlightCause::none);
    loop.order(CommandKind::mark);
    loop.cycles(2);
    EXPECT_EQ(cause_of(), record::FlightCause::request);
    loop.device_.inject(SimFault::unplugged);
    loop.cycles(50);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(cause_of(), record::FlightCause::fault);
}

TEST(FlightTape, the_gravest_reason_of_a_batch_counts) {
    Batch batch;
    const auto add = [&](EventCode code, double a) {
        EventTopic e{};
        e.code = static_cast<std::uint16_t>(code);
        e.a = a;
        batch.events.push_back(e);
        return record::reason_in(batch);
    };
    EXPECT_EQ(add(EventCode::overrun, 1200.0).cause, record::FlightCause::overrun);
    EXPECT_EQ(add(EventCode::command_done, static_cast<double>(CommandKind::mark)).cause,
              record::FlightCause::request);
    const record::FlightReason fault = add(EventCode::fault_latched, 1.0);
    EXPECT_EQ(fault.cause, record::FlightCause::fault);
    EXPECT_EQ(add(EventCode::overrun, 9.0).text, fault.text);
}

TEST(FlightFiles, of_overruns_go_before_those_of_marks_and_those_before_those_of_faults) {
    const auto at = [](int second, const char* suffix) {
        char text[64];
        std::snprintf(text, sizeof text, "flight-20261128T0830%02d.000Z%s.h5", second, suffix);
        return std::string(text);
    };
    const std::vector<std::string> names{at(1, "-fault"),   at(2, "-mark"),
                                         at(3, "-overrun"), at(4, "-overrun"),
                                         at(5, "-fault"),   at(6, "-overrun"),
                                         at(0, ""),         "flight-plan.h5",
                                         "notes.txt",       "flight-20261128T083007.000Z-other.h5"};
    EXPECT_TRUE(record::surplus_flights(names, 7).empty());
    EXPECT_EQ(record::surplus_flights(names, 5), (std::vector{at(0, ""), at(3, "-overrun")}));
    EXPECT_EQ(record::surplus_flights(names, 2), (std::vector{at(0, ""), at(3, "-overrun"), at(4, "-overrun"),
                                                              at(6, "-overrun"), at(2, "-mark")}));
}

}  // namespace
}  // namespace tact::record_scenario_test
