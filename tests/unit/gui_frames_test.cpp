// Frames and their passes: what counts as late, and that reading the renderer's stamps never waits.
#include <gtest/gtest.h>

#include <thread>

#include "gui/window/frame_report.hpp"
#include "ipc/base/error.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

TEST(FrameClock, a_frame_more_than_half_a_period_overdue_is_late) {
    FrameClock clock;
    for (int i = 0; i < 3; ++i) {
        clock.begin(0.001);  // due in a millisecond, and takes five
        std::this_thread::sleep_for(milliseconds(5));
    }
    for (int i = 0; i < 3; ++i) clock.begin(100.0);
    for (int i = 0; i < 3; ++i) {
        clock.begin(0.0);  // none is due
        std::this_thread::sleep_for(milliseconds(2));
    }
    FrameMetrics f{};
    clock.fill(f);
    EXPECT_EQ(f.frames, 8U);  // the last one has not ended
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

TEST_F(GuiFrames, processor_time_is_of_each_pass_and_of_the_paths_it_belongs_to) {
    PassClock clock(PassClock::Drawn::unknown);
    for (int i = 0; i < 5; ++i) frame(clock, 1);
    FrameMetrics f{};
    clock.fill(f);
    EXPECT_GE(of(clock, Pass::motion).work_p50_s, 0.001F);
    EXPECT_GT(of(clock, Pass::marks).work_p50_s, 0.0F);
    EXPECT_EQ(of(clock, Pass::bone).work_p99_s, 0.0F);
    EXPECT_EQ(f.path[2].work_p50_s, of(clock, Pass::motion).work_p50_s);  // and no particles were drawn
    EXPECT_EQ(f.path[0].work_p99_s, 0.0F);
    EXPECT_LT(of(clock, Pass::marks).drawn_p50_s, 0.0F);  // absent, not nothing
    EXPECT_LT(f.path[2].drawn_p99_s, 0.0F);
}

TEST_F(GuiFrames, one_frame_in_many_is_finished_where_the_processor_draws) {
    EXPECT_EQ(PassClock::possible(true), PassClock::Drawn::finished);
    PassClock clock(PassClock::Drawn::finished);
    for (int i = 0; i < 8; ++i) frame(clock, 1);
    EXPECT_LT(of(clock, Pass::marks).drawn_p50_s, 0.0F);
    for (std::uint32_t i = 0; i < kFinishEvery; ++i) frame(clock, 1);
    EXPECT_GT(of(clock, Pass::marks).drawn_p50_s, 0.0F);
    EXPECT_GE(of(clock, Pass::motion).drawn_p50_s, 0.001F);
}

TEST_F(GuiFrames, stamps_are_read_once_they_are_there) {
    if (PassClock::possible(false) != PassClock::Drawn::stamped) GTEST_SKIP() << "this driver stamps nothing";
    PassClock clock(PassClock::Drawn::stamped);
    const std::uint32_t held = gl_names_held();
    EXPECT_GE(held, 2 * PassClock::kFramesInFlight * PassClock::kScopesMost);
    const std::size_t frames = 3 * PassClock::kFramesInFlight;
    // More scopes than there are stamps for are left out, not written beyond.
    for (std::size_t i = 0; i < frames; ++i) {
        frame(clock, i % 3 == 0 ? 2 * static_cast<int>(PassClock::kScopesMost) : 2);
        glFinish();
    }
    EXPECT_EQ(clock.lost(), 0U);
    EXPECT_GE(of(clock, Pass::marks).drawn_p99_s, 0.0F);
    EXPECT_LT(of(clock, Pass::motion).drawn_p50_s, 0.0F);  // the renderer has no part in it
    EXPECT_LT(of(clock, Pass::swap).drawn_p50_s, 0.0F);
}

TEST_F(GuiFrames, names_that_are_given_back_are_counted) {
    const std::uint32_t before = gl_names_held();
    {
        GlBuffer buffer;
        EXPECT_EQ(gl_names_held(), before);  // not before somebody asks for it
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

TEST(FrameReport, tells_the_memory_and_refuses_a_path_that_cannot_be_written) {
    EXPECT_THROW(write_frame_report("/nowhere/at/all.json", FrameMetrics{}), StartupError);
    write_frame_report("", FrameMetrics{});  // nobody asked
}

}  // namespace
}  // namespace tact
