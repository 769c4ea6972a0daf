// What a person requests of a replay: play, pause, speed, another place.
//
// Thread   frame thread
#pragma once

#include <cstdint>

#include "gui/dashboard/timeline.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/replay.hpp"

namespace tact {

class TimelineSender {
public:
    explicit TimelineSender(Latest<TimelineTopic>& to) : to_(to) {}
    // replay: the newest state; the request changes that.
    void send(const TimelineRequest& request, const ReplayTopic& replay, std::int64_t now_ns);
    // A place that was requested and is not shown yet.
    [[nodiscard]] bool waits(const ReplayTopic& replay) const { return replay.seeks != sent_.seeks; }

private:
    Latest<TimelineTopic>& to_;
    TimelineTopic sent_{};
};

}  // namespace tact
