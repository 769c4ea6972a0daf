#include "gui/link/controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "gui/link/region_checks.hpp"

namespace tact {

Controller::News Controller::poll() {
    LinkClient::News news = link_.poll();
    News told;
    if (news.left) {
        told.left = !region_.empty();
        region_ = MappedRegion<RtRegion>();
        bone_ = MappedBoneRegion();
        refusal_.clear();
        bone_refusal_.clear();
    }
    if (news.arrived) {
        refusal_.clear();
        bone_refusal_.clear();
        region_ = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal_);
        bone_ = MappedBoneRegion();
        if (news.bone_fd.valid()) bone_ = MappedBoneRegion::map(std::move(news.bone_fd), bone_refusal_);
        seen_tool_ = seen_second_ = seen_bodies_ = seen_shapes_ = seen_touch_ = seen_drill_ = seen_head_ =
            seen_tracker_ = seen_devices_ = seen_health_ = seen_lateness_ = seen_levels_ = seen_recorders_ =
                seen_mark_ = seen_mouse_ = seen_replay_ = seen_replay_marks_ = 0;
        have_tool = have_second = have_bodies = have_shapes = have_touch = have_drill = have_head =
            have_tracker = have_devices = have_health = have_lateness = have_levels = have_recorders =
                have_mark = have_mouse = have_replay = have_replay_marks = false;
        cursor_ = trace_cursor_ = RingCursor{};
        told.arrived = !region_.empty();
        if (region_.empty()) refusal_ = "the controller's region cannot be used: " + refusal_;
    }
    return told;
}

template <class T>
bool Controller::take(const Latest<T>& latest, std::uint64_t& seen, T& value, bool& have) {
    const std::uint64_t count = latest.count();
    if (count == seen) return false;
    T candidate;
    if (!latest.read(candidate)) return false;
    seen = count;
    if (!sensible(candidate)) {
        ++refused_;
        return false;
    }
    value = candidate;
    have = true;
    return true;
}

Controller::Fresh Controller::read() {
    if (region_.empty()) return {};
    Fresh fresh;
    fresh.tool = take(region_->tool[0], seen_tool_, tool, have_tool);
    fresh.second = take(region_->tool[1], seen_second_, second, have_second);
    fresh.bodies = take(region_->bodies, seen_bodies_, bodies, have_bodies);
    fresh.shapes = take(region_->shapes, seen_shapes_, shapes, have_shapes);
    fresh.touch = take(region_->touch, seen_touch_, touch, have_touch);
    fresh.drill = take(region_->drill, seen_drill_, drill, have_drill);
    fresh.head = take(region_->head, seen_head_, head, have_head);
    fresh.tracker = take(region_->tracker, seen_tracker_, tracker, have_tracker);
    fresh.devices = take(region_->devices, seen_devices_, devices, have_devices);
    fresh.lateness = take(region_->lateness, seen_lateness_, lateness, have_lateness);
    static_cast<void>(take(region_->replay, seen_replay_, replay, have_replay));
    static_cast<void>(take(region_->replay_marks, seen_replay_marks_, replay_marks, have_replay_marks));
    fresh.mark = take(region_->mark, seen_mark_, mark, have_mark);
    static_cast<void>(take(region_->mouse, seen_mouse_, mouse, have_mouse));
    fresh.recorders = take(region_->recorders, seen_recorders_, recorders, have_recorders);
    fresh.health = take(region_->health, seen_health_, health, have_health);
    fresh.levels = take(region_->levels, seen_levels_, levels, have_levels);
    return fresh;
}

bool Controller::next_event(EventTopic& event) {
    return !region_.empty() && region_->events.next(cursor_, event);
}

bool Controller::next_cycle(TraceTopic& cycle) {
    return !region_.empty() && region_->trace.next(trace_cursor_, cycle);
}

bool Controller::next_cycle(RingCursor& place, TraceTopic& cycle) const {
    return !region_.empty() && region_->trace.next(place, cycle);
}

const PathLevel* Controller::level(const char* path) const {
    return attached() && have_levels ? find_path(levels, path) : nullptr;
}

double Controller::time_rate() const {
    if (!replays()) return 1.0;
    return replay.act == static_cast<std::uint8_t>(ReplayAct::playing) ? replay.speed : 0.0;
}

std::int64_t Controller::time_ns(std::int64_t now_ns) const {
    if (!replays()) return now_ns;
    constexpr double kMostNs = 5e7;  // a replay says where it is a hundred times a second
    const double age_ns = std::clamp(static_cast<double>(now_ns - replay.taken_at_ns), 0.0, kMostNs);
    return replay.shown_ns + std::llround(time_rate() * age_ns);
}

std::string Controller::scene_path() const {
    if (region_.empty()) return {};
    char path[sizeof region_->scene_path];
    std::memcpy(path, region_->scene_path, sizeof path);  // written once, before the ready flag
    path[sizeof path - 1] = '\0';
    return path;
}

}  // namespace tact
