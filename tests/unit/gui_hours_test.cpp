// Hours of data: the dashboard's memory does not grow, and a frame allocates no more than after minutes.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "gui/window/show_controller.hpp"
#include "ipc/base/run_state.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace {

std::atomic<long long> live_bytes{0};
std::atomic<long long> allocations{0};

void* taken(std::size_t size) {
    void* const p = std::malloc(size > 0 ? size : 1);
    if (p == nullptr) throw std::bad_alloc();
    live_bytes += static_cast<long long>(malloc_usable_size(p));
    ++allocations;
    return p;
}

void given_back(void* p) {
    if (p == nullptr) return;
    live_bytes -= static_cast<long long>(malloc_usable_size(p));
    std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return taken(size); }
void* operator new[](std::size_t size) { return taken(size); }
void operator delete(void* p) noexcept { given_back(p); }
void operator delete[](void* p) noexcept { given_back(p); }
void operator delete(void* p, std::size_t) noexcept { given_back(p); }
void operator delete[](void* p, std::size_t) noexcept { given_back(p); }

namespace tact {
namespace {

// Simulates a controller at 1 kHz and a window at 60 frames/s.
class Hours : public testing::Test {
protected:
    Hours() {
        ImGui::SetAllocatorFunctions([](std::size_t size, void*) { return taken(size); },
                                     [](void* p, void*) { given_back(p); });
    }
    // Advances by 1/60 s without drawing.
    void tick(DashboardState& state) {
        ++frame_;
        const double now_s = static_cast<double>(frame_) / 60.0;
        state.history.now_s = now_s;
        state.now_ns = 1'000'000'000 + static_cast<std::int64_t>(1e9 * now_s);
        LoadTopic load{};
        load.frame = frame_;
        load.frame_s = load.busy_s = 0.016 + 0.004 * std::sin(now_s);
        levels_.path[0].level = 0.5F + 0.4F * std::sin(0.1F * static_cast<float>(now_s));
        add_load(load, &levels_, state.history);
        if (frame_ % 6 == 0) {
            HealthTopic h{};
            h.taken_at_ns = state.now_ns;
            h.force_rate_hz = h.goal_hz = 1000.0;
            h.period_ns = 1'000'000;
            h.lateness_p99_ns = 20'000;
            h.state = static_cast<std::uint8_t>(RunState::active);
            state.health = h;
            state.have_health = state.attached = true;
            add_health(h, state.history);
            state.device_rate[0].add(state.now_ns, frame_ * 16);
            // Levels that change all the time.
            state.history.knobs.add(now_s, frame_ / 6 % 3, 0.5 + 0.4 * std::sin(now_s),
                                    frame_ % 12 == 0 ? LevelReason::rate_low : LevelReason::rate_high);
        }
        if (frame_ % 60 == 0) {
            lateness_.total += 1000;
            lateness_.counts[100 + frame_ / 60 % 50] += 1000;
            lateness_.max_ns = 90'000;
            lateness_.taken_at_ns = state.now_ns;
            state.lateness.add(lateness_);
        }
        while (cycle_ * 1'000'000 < static_cast<std::int64_t>(1e9 * now_s)) {
            TraceTopic t{};
            t.taken_at_ns = 1'000'000'000 + ++cycle_ * 1'000'000;
            t.cycle = static_cast<std::uint64_t>(cycle_);
            t.force_world_n[0] = 0.01F * static_cast<float>(cycle_ % 100);
            t.cost_ns = 90'000;
            state.traces.scope.add(t, 1'000'000);
        }
    }
    void hours(test::TestDashboard& dashboard, double h) {
        const auto until = frame_ + static_cast<std::uint64_t>(h * 3600.0 * 60.0);
        while (frame_ < until) {
            tick(dashboard.state);
            if (frame_ % 3600 == 0) dashboard.frame();
        }
    }

    std::uint64_t frame_ = 0;
    std::int64_t cycle_ = 0;
    LevelsTopic levels_ = [] {
        LevelsTopic l{};
        l.count = 2;
        return l;
    }();
    LatenessTopic lateness_{};
};

TEST_F(Hours, take_no_more_memory_than_minutes) {
    test::TestDashboard dashboard(1280.0F, 720.0F, 1.0F);
    dashboard.state.have_levels = true;
    dashboard.state.levels = levels_;
    for (int strip : {0, 1}) {
        dashboard.state.strip = strip;
        dashboard.state.span_choice = 4;
        if (strip == 1) dashboard.state.traces.scope.choose_run(TraceRun::automatic);
        for (int i = 0; i < 5; ++i) dashboard.frame();
        hours(dashboard, 0.05);
        for (int i = 0; i < 5; ++i) dashboard.frame();
        const long long before = live_bytes;
        hours(dashboard, 1.0);
        dashboard.frame();
        // Draw buffers grow with the drawn data, for example once a plot is full.
        EXPECT_LT(live_bytes - before, 512 * 1024) << "strip " << strip;
    }
    EXPECT_GT(cycle_, 7'000'000);
    EXPECT_GT(dashboard.state.history.knobs.forgotten(), 1000U);
}

TEST_F(Hours, a_running_dashboard_adds_samples_without_allocation) {
    auto state = std::make_unique<DashboardState>();
    for (int i = 0; i < 600; ++i) tick(*state);
    const long long before = allocations;
    for (int i = 0; i < 36'000; ++i) tick(*state);  // ten minutes
    EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace tact
