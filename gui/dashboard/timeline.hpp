// The timeline, a strip between the 3D view and the plots: of a replay, with play, pause, step, speed, and marks at events; of a live run, the last
// seconds, which its flight recorder keeps, to look back.
//
// Thread   frame thread, inside an ImGui frame
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/theme.hpp"
#include "ipc/topics/replay.hpp"

namespace tact {

enum class TimelineAction : std::uint8_t {
    play,   // or pause; at the end: from the start
    speed,  // value
    seek,   // value: s
    step,   // value: steps on; negative: back
    run,    // live, from the moment shown
};

struct TimelineRequest {
    TimelineAction action = TimelineAction::play;
    double value = 0.0;
};

struct ReplayState {
    bool shown = false;  // the window shows a recording
    ReplayTopic now{};
    ReplayMarks marks{};
    double dragged_s = -1.0;                // place under the held mouse; below 0: not held
    std::vector<TimelineRequest> requests;  // emptied by the application
};

// The last seconds of a live run.
struct PastState {
    static constexpr double kLengthS = 30.0;  // that a flight recorder keeps
    bool shown = false;
    struct Mark {
        double ago_s = 0.0;
        Grade grade = Grade::unknown;
        std::string text;
    };
    std::vector<Mark> marks;
    double wanted_ago_s = -1.0;  // the moment that the person wants to see; below 0: none
};

inline constexpr float kTimelineHeight = 66.0F, kPastHeight = 38.0F;  // at scale 1

// "paused at 12.340 s of 130.0 s", "playing at 0.5 x, 12.3 s of 130.0 s", "looking for 40.0 s: 43 %".
[[nodiscard]] std::string replay_text(const ReplayTopic& replay);
void draw_timeline(const Theme& theme, ReplayState& state, const PixelRect& card);
void draw_past(const Theme& theme, PastState& state, const PixelRect& card);

}  // namespace tact
