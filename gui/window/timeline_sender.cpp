#include "gui/window/timeline_sender.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

void TimelineSender::send(const TimelineRequest& request, const ReplayTopic& replay, std::int64_t now_ns) {
    // A step from a place that is still looked for counts from there.
    const std::uint64_t from = waits(replay) && sent_.seek_step > 0 ? sent_.seek_step : replay.step;
    TimelineTopic t = sent_;
    t.taken_at_ns = now_ns;
    t.speed = replay.speed;
    t.playing = replay.plays;
    const auto seek = [&](double at_s, std::uint64_t step) {
        t.seeks = std::max(sent_.seeks, replay.seeks) + 1;
        t.seek_s = at_s;
        t.seek_step = step;
    };
    switch (request.action) {
        case TimelineAction::play:
            t.playing = replay.plays != 0 ? 0 : 1;
            if (replay.act == static_cast<std::uint8_t>(ReplayAct::ended)) {
                t.playing = 1;
                seek(0.0, 0);
            }
            break;
        case TimelineAction::speed:
            t.speed = std::clamp(request.value, TimelineTopic::kSpeedLeast, TimelineTopic::kSpeedMost);
            break;
        case TimelineAction::seek:
            seek(std::clamp(request.value, 0.0, replay.duration_s), 0);
            break;
        case TimelineAction::run:
            t.runs = std::max(sent_.runs, replay.runs) + 1;
            t.playing = 0;
            break;
        case TimelineAction::step: {
            t.playing = 0;
            const double most = static_cast<double>(std::max<std::uint64_t>(replay.steps, 1));
            seek(0.0, static_cast<std::uint64_t>(
                          std::llround(std::clamp(static_cast<double>(from) + request.value, 1.0, most))));
            break;
        }
    }
    sent_ = t;
    to_.publish(t);
}

}  // namespace tact
