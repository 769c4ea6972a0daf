// Frame metrics: plausibility checks, texts, and the percentiles behind them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "ipc/base/recent_times.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/levels.hpp"

namespace tact::ipc_frames_test {
namespace {

FrameMetrics good() {
    FrameMetrics f{};
    f.frames = 100;
    f.late = 3;
    f.due_s = 1.0 / 30.0;
    f.p50_s = f.run_p50_s = 0.03F;
    f.p99_s = f.run_p99_s = 0.05F;
    f.most_s = f.run_most_s = 0.3F;
    f.window = 99;
    for (PassMetrics& p : f.pass) p = {1e-3F, 2e-3F, -1.0F, -1.0F};
    for (PassMetrics& p : f.path) p = {1e-3F, 2e-3F, 3e-3F, 4e-3F};
    return f;
}

TEST(Frames, impossible_metrics_are_refused) {
    EXPECT_TRUE(plausible(good()));
    EXPECT_TRUE(plausible(FrameMetrics{}));
    const auto refused = [](const auto& spoil) {
        FrameMetrics f = good();
        spoil(f);
        return !plausible(f);
    };
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.late = 101; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.frames = f.late = ~std::uint64_t{0}; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.due_s = -1.0; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.due_s = std::numeric_limits<double>::infinity(); }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.p50_s = 0.06F; }));  // above p99
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.run_most_s = 0.04F; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.most_s = kNaN; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.gl_objects = ~0U; }));
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.heap_bytes = ~std::uint64_t{0}; }));
    for (std::size_t i = 0; i < kPasses; ++i) {
        EXPECT_TRUE(refused([i](FrameMetrics& f) { f.pass[i].work_p50_s = kNaN; }));
        EXPECT_TRUE(refused([i](FrameMetrics& f) { f.pass[i].work_p50_s = -1.0F; }));
        EXPECT_TRUE(refused([i](FrameMetrics& f) { f.pass[i].drawn_p99_s = 1.0F; }));  // without p50
        EXPECT_TRUE(refused([i](FrameMetrics& f) { f.pass[i].drawn_p50_s = kNaN; }));
    }
    EXPECT_TRUE(refused([](FrameMetrics& f) { f.path[2].work_p99_s = 1e9F; }));
}

TEST(Frames, any_bytes_are_checked_without_harm) {
    std::mt19937 random(5);
    for (int i = 0; i < 20000; ++i) {
        FrameMetrics f{};
        auto* const bytes = reinterpret_cast<unsigned char*>(&f);
        for (std::size_t k = 0; k < sizeof f; ++k) bytes[k] = static_cast<unsigned char>(random());
        if (!plausible(f)) continue;
        EXPECT_LE(f.late, f.frames);
        EXPECT_TRUE(std::isfinite(f.run_most_s));
    }
}

TEST(Frames, passes_and_paths_have_names_of_their_own) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < kPasses; ++i)
        EXPECT_TRUE(seen.insert(pass_text(static_cast<Pass>(i))).second) << i;
    EXPECT_STREQ(pass_text(Pass::count), "unknown");
    EXPECT_STREQ(visual_path_text(0), kMeshPath);
    EXPECT_STREQ(visual_path_text(1), kVolumePath);
    EXPECT_STREQ(visual_path_text(2), kParticlesPath);
    EXPECT_STREQ(visual_path_text(3), kMoleculesPath);
    EXPECT_STREQ(visual_path_text(4), kResolutionPath);
    EXPECT_STREQ(visual_path_text(kVisualPaths), "");
}

TEST(RecentTimes, percentiles_cover_only_the_window) {
    RecentTimes times(100);
    EXPECT_EQ(times.percentile_s(0.5), 0.0F);
    times.add(7.0);
    EXPECT_EQ(times.percentile_s(0.0), 7.0F);
    EXPECT_EQ(times.percentile_s(0.99), 7.0F);
    for (int i = 1; i <= 100; ++i) times.add(i);  // the 7 has left the window
    EXPECT_EQ(times.size(), 100U);
    EXPECT_EQ(times.percentile_s(0.0), 1.0F);
    EXPECT_EQ(times.percentile_s(0.5), 51.0F);
    EXPECT_EQ(times.percentile_s(0.99), 100.0F);  // rounded up
    for (int i = 0; i < 50; ++i) times.add(1000.0);
    EXPECT_EQ(times.percentile_s(0.25), 76.0F);
    EXPECT_EQ(times.most_s(), 1000.0F);
}

}  // namespace
}  // namespace tact::ipc_frames_test
