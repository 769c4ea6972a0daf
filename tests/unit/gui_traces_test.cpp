// The traces: the store, the trigger, the scope and the CSV export.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "gui/dashboard/plot.hpp"
#include "gui/dashboard/trace_scope.hpp"
#include "ipc/base/run_state.hpp"

namespace tact::gui_traces_test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod = kMs;

TraceTopic cycle_at(std::int64_t number, double force_n = 0.0, std::int32_t cost_ns = 100'000) {
    TraceTopic t{};
    t.taken_at_ns = 1'000'000'000 + number * kMs;
    t.cycle = static_cast<std::uint64_t>(number);
    t.force_world_n[0] = static_cast<float>(force_n);
    t.cost_ns = cost_ns;
    t.status = static_cast<std::uint32_t>(RunState::active);
    return t;
}

TEST(TraceStore, extremes_of_any_range_equal_those_of_its_cycles) {
    TraceStore store;
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 1.0);
    const auto total = static_cast<std::int64_t>(TraceStore::kSlots + TraceStore::kSlots / 3 + 17);
    for (std::int64_t i = 1; i <= total; ++i) ASSERT_TRUE(store.add(cycle_at(i, noise(random))));
    EXPECT_EQ(store.size(), TraceStore::kKept);
    EXPECT_EQ(store.at(store.size() - 1).cycle, static_cast<std::uint64_t>(total));
    EXPECT_EQ(store.at(0).cycle, static_cast<std::uint64_t>(total) - TraceStore::kKept + 1);
    std::uniform_int_distribution<std::size_t> place(0, store.size());
    for (int round = 0; round < 300; ++round) {
        std::size_t first = place(random), last = place(random);
        if (first > last) std::swap(first, last);
        if (round % 2 == 0) last = std::min(last, first + 100);
        const TraceExtremes e = store.extremes(TraceChannel::force_x, first, last);
        EXPECT_EQ(e.any, last > first);
        float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
        for (std::size_t i = first; i < last; ++i) {
            low = std::min(low, store.at(i).force_world_n[0]);
            high = std::max(high, store.at(i).force_world_n[0]);
        }
        if (!e.any) continue;
        EXPECT_EQ(e.low, low);
        EXPECT_EQ(e.high, high);
    }
}

TEST(TraceStore, finds_times_and_gaps_and_refuses_impossible_cycles) {
    TraceStore store;
    EXPECT_TRUE(store.empty());
    EXPECT_EQ(store.find(5), 0U);
    for (const std::int64_t i : {1, 2, 3, 7, 8}) ASSERT_TRUE(store.add(cycle_at(i)));
    EXPECT_EQ(store.find(cycle_at(3).taken_at_ns), 2U);
    EXPECT_EQ(store.find(cycle_at(3).taken_at_ns + 1), 3U);
    EXPECT_EQ(store.find(cycle_at(99).taken_at_ns), store.size());
    EXPECT_FALSE(store.gap_before(0));
    EXPECT_FALSE(store.gap_before(2));
    EXPECT_TRUE(store.gap_before(3));
    EXPECT_FALSE(store.add(cycle_at(8)));  // a repeated cycle
    EXPECT_FALSE(store.add(cycle_at(5)));  // an older cycle
    TraceTopic far{};
    far.taken_at_ns = std::numeric_limits<std::int64_t>::max();
    EXPECT_FALSE(store.add(far));
    EXPECT_FALSE(store.add(TraceTopic{}));
    EXPECT_EQ(store.refused(), 4U);
    TraceTopic odd = cycle_at(9);
    odd.force_world_n[0] = std::numeric_limits<float>::quiet_NaN();
    odd.pos_world_m[1] = std::numeric_limits<float>::infinity();
    ASSERT_TRUE(store.add(odd));
    EXPECT_FALSE(store.extremes(TraceChannel::force, 5, 6).any);
    EXPECT_FALSE(store.extremes(TraceChannel::position_y, 5, 6).any);
    EXPECT_TRUE(store.extremes(TraceChannel::cost, 5, 6).any);
}

// A force that rises slowly from -1 to 1 N and falls again, with a period of 200 cycles.
double triangle_n(std::int64_t i) {
    const auto phase = static_cast<double>(i % 200);
    return phase < 100.0 ? -1.0 + 0.02 * phase : 1.0 - 0.02 * (phase - 100.0);
}

TEST(TraceTrigger, fires_where_the_channel_crosses_the_level_in_the_chosen_direction) {
    for (const bool rising : {true, false}) {
        TraceTrigger trigger;
        trigger.arm(
            {TriggerSource::channel, TraceChannel::force_x, rising, 0.5, TriggerMode::single, 0.25, 0.04});
        std::int64_t i = 1;
        while (i < 1000 && !trigger.add(cycle_at(i, triangle_n(i)), kPeriod)) ++i;
        ASSERT_LT(i, 1000) << rising;
        const std::int64_t at = (trigger.capture().trigger_ns - cycle_at(0).taken_at_ns) / kMs;
        EXPECT_EQ(at, rising ? 75 : 125);
        EXPECT_EQ(trigger.capture().begin_ns, trigger.capture().trigger_ns - 10 * kMs);
        EXPECT_EQ(trigger.capture().end_ns, trigger.capture().trigger_ns + 30 * kMs);
        EXPECT_EQ(i, at + 30);  // reported once the capture has reached its end
        EXPECT_FALSE(trigger.capture().forced);
        EXPECT_EQ(trigger.state(), TraceTrigger::State::done);
        for (++i; i < 2000; ++i) ASSERT_FALSE(trigger.add(cycle_at(i, triangle_n(i)), kPeriod));
    }
}

TEST(TraceTrigger, normal_captures_repeatedly_and_automatic_forces_a_capture_after_a_time) {
    TraceTrigger normal;
    normal.arm({TriggerSource::channel, TraceChannel::force_x, true, 0.5, TriggerMode::normal, 0.0, 0.1});
    int captures = 0;
    for (std::int64_t i = 1; i < 2000; ++i)
        captures += normal.add(cycle_at(i, triangle_n(i)), kPeriod) ? 1 : 0;
    EXPECT_EQ(captures, 10);
    normal.arm({TriggerSource::channel, TraceChannel::force_x, true, 5.0, TriggerMode::normal, 0.0, 0.1});
    for (std::int64_t i = 2000; i < 9000; ++i) ASSERT_FALSE(normal.add(cycle_at(i, triangle_n(i)), kPeriod));
    EXPECT_EQ(normal.state(), TraceTrigger::State::waiting);

    TraceTrigger automatic;
    automatic.arm(
        {TriggerSource::channel, TraceChannel::force_x, true, 5.0, TriggerMode::automatic, 0.5, 0.1});
    int forced = 0;
    for (std::int64_t i = 1; i < 2100; ++i)
        if (automatic.add(cycle_at(i, triangle_n(i)), kPeriod)) {
            ++forced;
            EXPECT_TRUE(automatic.capture().forced);
            EXPECT_EQ(automatic.capture().end_ns, cycle_at(i).taken_at_ns);
        }
    EXPECT_EQ(forced, 4);  // one every half second
}

TEST(TraceTrigger, fires_on_an_overrun_and_on_the_start_of_a_fault) {
    TraceTrigger overrun;
    overrun.arm({TriggerSource::overrun, TraceChannel::force, true, 0.0, TriggerMode::normal, 0.5, 0.02});
    std::vector<std::int64_t> at;
    for (std::int64_t i = 1; i < 200; ++i)
        if (overrun.add(cycle_at(i, 0.0, i == 50 || i == 120 ? 1'200'000 : 900'000), kPeriod))
            at.push_back((overrun.capture().trigger_ns - cycle_at(0).taken_at_ns) / kMs);
    EXPECT_EQ(at, (std::vector<std::int64_t>{50, 120}));
    // A free-running loop has no period to overrun.
    overrun.arm(overrun.settings());
    for (std::int64_t i = 200; i < 400; ++i) ASSERT_FALSE(overrun.add(cycle_at(i, 0.0, 5'000'000), 0));

    TraceTrigger fault;
    fault.arm({TriggerSource::fault, TraceChannel::force, true, 0.0, TriggerMode::normal, 0.5, 0.02});
    int captures = 0;
    for (std::int64_t i = 1; i < 500; ++i) {
        TraceTopic t = cycle_at(i);
        if (i >= 100 && i < 300) t.status = static_cast<std::uint32_t>(RunState::fault);
        captures += fault.add(t, kPeriod) ? 1 : 0;
    }
    EXPECT_EQ(captures, 1);
}

TEST(TraceTrigger, nan_settings_and_values_trigger_nothing) {
    TraceTrigger trigger;
    trigger.arm({TriggerSource::channel, TraceChannel::force_x, true, std::nan(""), TriggerMode::normal,
                 std::nan(""), std::nan("")});
    for (std::int64_t i = 1; i < 3000; ++i) ASSERT_FALSE(trigger.add(cycle_at(i, triangle_n(i)), kPeriod));
    trigger.arm({TriggerSource::channel, TraceChannel::force_x, true, 0.0, TriggerMode::normal, 0.5, 0.1});
    for (std::int64_t i = 3000; i < 6000; ++i) ASSERT_FALSE(trigger.add(cycle_at(i, std::nan("")), kPeriod));
    trigger.disarm();
    EXPECT_FALSE(trigger.add(cycle_at(7000, 1.0), kPeriod));
}

TEST(TraceScope, rolls_holds_zooms_pans_and_resumes) {
    TraceScope scope;
    std::int64_t i = 1;
    for (; i <= 5000; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    EXPECT_STREQ(scope.status(), "running");
    EXPECT_EQ(scope.end_ns(), cycle_at(5000).taken_at_ns);
    scope.zoom(0.5, scope.begin_ns());
    EXPECT_NEAR(scope.span_s(), 0.5, 1e-12);
    EXPECT_FALSE(scope.held());  // still running
    scope.hold();
    for (; i <= 9000; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    EXPECT_EQ(scope.end_ns(), cycle_at(5000).taken_at_ns);
    EXPECT_EQ(scope.shown().end_ns(), cycle_at(5000).taken_at_ns);
    EXPECT_EQ(scope.live().end_ns(), cycle_at(9000).taken_at_ns);
    // The point under the mouse stays there.
    const std::int64_t about = scope.begin_ns() + 100 * kMs;
    const double share = 0.2;
    scope.zoom(0.5, about);
    EXPECT_NEAR(1e-9 * static_cast<double>(about - scope.begin_ns()), share * scope.span_s(), 1e-6);
    scope.pan(-1.0);
    EXPECT_LT(scope.end_ns(), cycle_at(4500).taken_at_ns);
    scope.pan(-1e6);  // limited to the stored cycles
    EXPECT_GT(scope.end_ns(), scope.shown().begin_ns());
    scope.pan(1e6);
    EXPECT_LT(scope.begin_ns(), scope.shown().end_ns());
    for (int k = 0; k < 200; ++k) scope.zoom(0.5, about);
    EXPECT_GE(scope.span_s(), TraceScope::kLeastSpan_s);
    for (int k = 0; k < 200; ++k) scope.zoom(2.0, about);
    EXPECT_LE(scope.span_s(), TraceScope::kMostSpan_s);
    scope.zoom(std::nan(""), about);
    scope.pan(std::nan(""));
    scope.go_on();
    EXPECT_EQ(scope.end_ns(), cycle_at(9000).taken_at_ns);
}

TEST(TraceScope, shows_a_capture_until_the_next_one) {
    TraceScope scope;
    TriggerSettings s;
    s.channel = TraceChannel::force_x;
    s.level = 0.5;
    s.pre_share = 0.25;
    scope.set_trigger(s);
    scope.set_span(0.04);
    std::int64_t i = 1;
    for (; i <= 50; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    scope.choose_run(TraceRun::single);
    EXPECT_STREQ(scope.status(), "waiting for the trigger");
    for (; i <= 5000; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    EXPECT_STREQ(scope.status(), "captured");
    EXPECT_EQ(scope.captures(), 1U);
    EXPECT_EQ(scope.triggered_ns(), cycle_at(75).taken_at_ns);
    EXPECT_EQ(scope.begin_ns(), cycle_at(65).taken_at_ns);
    EXPECT_EQ(scope.end_ns(), cycle_at(105).taken_at_ns);
    EXPECT_EQ(scope.shown().size(), 41U);  // cycles 65 to 105
    scope.choose_run(TraceRun::normal);
    for (; i <= 5500; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    EXPECT_GE(scope.captures(), 2U);
    EXPECT_GT(scope.triggered_ns(), cycle_at(5000).taken_at_ns);
    scope.hold();
    const std::int64_t kept = scope.triggered_ns();
    for (; i <= 7000; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    EXPECT_EQ(scope.triggered_ns(), kept);
    EXPECT_STREQ(scope.status(), "paused");
}

TEST(TraceScope, memory_is_allocated_once) {
    TraceScope scope;
    const std::size_t before = scope.memory_bytes();
    EXPECT_LT(before, 12U * 1024U * 1024U);
    for (std::int64_t i = 1; i < 200'000; ++i) scope.add(cycle_at(i, triangle_n(i)), kPeriod);
    scope.hold();
    EXPECT_EQ(scope.memory_bytes(), before);
    scope.clear();
    EXPECT_EQ(scope.memory_bytes(), before);
    EXPECT_TRUE(scope.shown().empty());
}

TEST(TraceCsv, gives_the_cycles_in_si_units) {
    std::vector<TraceTopic> cycles{cycle_at(5, 0.25), cycle_at(6, std::nan(""))};
    cycles[1].pos_world_m[1] = 0.0125F;
    cycles[1].status = static_cast<std::uint32_t>(RunState::fault);
    const TraceChannel channels[] = {TraceChannel::force_x, TraceChannel::position_y, TraceChannel::cost};
    std::istringstream in(trace_csv(cycles, channels));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "time_s,taken_at_ns,cycle,state,force_x_n,position_y_m,cost_s");
    std::getline(in, line);
    EXPECT_EQ(line, "0,1005000000,5,active,0.25,0,9.99999975e-05");
    std::getline(in, line);
    EXPECT_EQ(line.substr(0, line.find(",,")), "0.001,1006000000,6,fault");
    EXPECT_NE(line.find(",,0.0125"), std::string::npos) << line;  // NaN: an empty field
    EXPECT_FALSE(std::getline(in, line));
    EXPECT_EQ(trace_csv({}, channels), "time_s,taken_at_ns,cycle,state,force_x_n,position_y_m,cost_s\n");
}

TEST(PlotAxis, range_axis_covers_its_range_on_whole_steps) {
    for (const auto& [low, high] :
         {std::pair{-1.0, 1.0}, {0.2, 0.21}, {-5e-3, 7.0}, {3.0, 3.0}, {0.0, 0.0}, {-40.0, -39.0}}) {
        const Axis axis = range_axis(low, high, 4);
        EXPECT_LE(axis.low, low + 1e-9);
        EXPECT_GE(axis.high, high - 1e-9);
        EXPECT_GT(axis.high, axis.low);
        EXPECT_GE(axis.mark.size(), 2U);
        EXPECT_LE(axis.mark.size(), 8U);
    }
    EXPECT_GT(range_axis(std::nan(""), 1.0, 4).high, 0.0);
}

}  // namespace
}  // namespace tact::gui_traces_test
