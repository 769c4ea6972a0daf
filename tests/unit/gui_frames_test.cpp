// Frames and their passes: late frames, and reading of the renderer's timestamps without waiting.
#include <gtest/gtest.h>

#include <thread>

#include "gui/window/frame_report.hpp"
#include "ipc/base/error.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact::gui_frames_test {
namespace {

using std::chrono::milliseconds;

TEST(FrameClock, a_frame_more_than_half_a_period_overdue_is_late) {
    FrameClock clock;
    for (int i = 0; i < 3; ++i) {
        clock.begin(0.001);  // due after 1 ms, takes 5 ms
        std::this_thread::sleep_for(milliseconds(5));
    }
    for (int i = 0; i < 3; ++i) clock.begin(100.0);
    for (int i = 0; i < 3; ++i) {
        clock.begin(0.0);  // no due time
        std::this_thread::sleep_for(milliseconds(2));
    }
    FrameMetrics f{};
    clock.fill(f);
    EXPECT_EQ(f.frames, 8U);  // the last frame has not ended
    EXPECT_EQ(f.late, 3U);
    EXPECT_EQ(f.due_s, 0.0);
    EXPECT_EQ(f.window, 8U);
    EXPECT_GE(f.most_s, 0.005F);
    EXPECT_GE(f.run_most_s, 0.005F);
    EXPECT_TRUE(plausible(f));
}

class GuiFrames : public Canvas<160, 120> {
protected:
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}); }
    static void frame(PassClock& clock, int marks) {
        clock.begin_frame();
        for (int i = 0; i < marks; ++i) {
            const PassClock::Scope scope(&clock, Pass::marks);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        }
        {
            const PassClock::Scope scope(&clock, Pass::motion);
            std::this_thread::sleep_for(milliseconds(1));
        }
        clock.end_frame();
    }
    static PassMetrics of(const PassClock& clock, Pass pass) {
        FrameMetrics f{};
        clock.fill(f);
        EXPECT_TRUE(plausible(f));
        return f.pass[static_cast<std::size_t>(pass)];
    }
};

TEST_F(GuiFrames, processor_time_is_attributed_to_passes_and_paths) {
    PassClock clock(PassClock::Drawn::unknown);
    for (int i = 0; i < 5; ++i) frame(clock, 1);
    FrameMetrics f{};
    clock.fill(f);
    EXPECT_GE(of(clock, Pass::motion).work_p50_s, 0.001F);
    EXPECT_GT(of(clock, Pass::marks).work_p50_s, 0.0F);
    EXPECT_EQ(of(clock, Pass::bone).work_p99_s, 0.0F);
    EXPECT_EQ(f.path[2].work_p50_s, of(clock, Pass::motion).work_p50_s);  // no particles were drawn
    EXPECT_EQ(f.path[0].work_p99_s, 0.0F);
    EXPECT_LT(of(clock, Pass::marks).drawn_p50_s, 0.0F);  // absent, not zero
    EXPECT_LT(f.path[2].drawn_p99_s, 0.0F);
}

TEST_F(GuiFrames, with_software_rendering_some_frames_are_finished_for_timing) {
    EXPECT_EQ(PassClock::possible(true), PassClock::Drawn::finished);
    PassClock clock(PassClock::Drawn::finished);
    for (int i = 0; i < 8; ++i) frame(clock, 1);
    EXPECT_LT(of(clock, Pass::marks).drawn_p50_s, 0.0F);
    for (std::uint32_t i = 0; i < kFinishEvery; ++i) frame(clock, 1);
    EXPECT_GT(of(clock, Pass::marks).drawn_p50_s, 0.0F);
    EXPECT_GE(of(clock, Pass::motion).drawn_p50_s, 0.001F);
}

TEST_F(GuiFrames, timestamps_are_read_once_available) {
    if (PassClock::possible(false) != PassClock::Drawn::stamped) GTEST_SKIP() << "this driver stamps nothing";
    PassClock clock(PassClock::Drawn::stamped);
    const std::uint32_t held = gl_names_held();
    EXPECT_GE(held, 2 * PassClock::kFramesInFlight * PassClock::kScopesMost);
    const std::size_t frames = 3 * PassClock::kFramesInFlight;
    // More scopes than available timestamps are skipped, not written out of bounds.
    for (std::size_t i = 0; i < frames; ++i) {
        frame(clock, i % 3 == 0 ? 2 * static_cast<int>(PassClock::kScopesMost) : 2);
        glFinish();
    }
    EXPECT_EQ(clock.lost(), 0U);
    EXPECT_GE(of(clock, Pass::marks).drawn_p99_s, 0.0F);
    EXPECT_LT(of(clock, Pass::motion).drawn_p50_s, 0.0F);  // no work for the renderer
    EXPECT_LT(of(clock, Pass::swap).drawn_p50_s, 0.0F);
}

TEST_F(GuiFrames, released_gl_names_are_counted) {
    const std::uint32_t before = gl_names_held();
    {
        GlBuffer buffer;
        EXPECT_EQ(gl_names_held(), before);  // created only on first use
        buffer.get();
        buffer.get();
        GlTexture texture;
        texture.get();
        const OffscreenTarget target(8, 8);
        EXPECT_EQ(gl_names_held(), before + 5);
        const GlBuffer moved = std::move(buffer);
        EXPECT_EQ(gl_names_held(), before + 5);
    }
    target_->bind();
    EXPECT_EQ(gl_names_held(), before);
}

TEST(FrameReport, refuses_an_unwritable_path) {
    EXPECT_THROW(write_frame_report("/nowhere/at/all.json", FrameMetrics{}), StartupError);
    write_frame_report("", FrameMetrics{});  // no report requested
}

}  // namespace
}  // namespace tact::gui_frames_test
