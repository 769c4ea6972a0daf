// The window's connection to the controller: attached or waiting, with the newest valid records.
//
// Survives  the controller's end and restart: the last records stay, and attached() is false
// Hostile   every record is checked (region_checks.hpp); refused() counts those rejected
// Thread    frame thread; nothing blocks
#pragma once

#include <cstdint>
#include <string>

#include "ipc/shm/link.hpp"
#include "ipc/topics/bone_region.hpp"
#include "ipc/topics/regions.hpp"

namespace tact {

class Controller {
public:
    // own_region_fd -1: an instructor, who watches.
    Controller(const std::string& session, int own_region_fd)
        : link_(session, own_region_fd, LinkRole::instructor), watches_(own_region_fd < 0) {}

    [[nodiscard]] bool watches() const { return watches_; }
    // As an instructor. False: not sent.
    bool stop_run() { return link_.order(LinkOrder::stop); }
    bool mark_place(const Vec3& model_m) {
        return link_.order(LinkOrder::mark, {model_m.x(), model_m.y(), model_m.z()});
    }

    struct News {
        bool arrived = false, left = false;
    };
    News poll();
    // Reads every topic; a flag is true if the topic has a new record.
    struct Fresh {
        bool tool = false, second = false, bodies = false, shapes = false, touch = false, drill = false,
             head = false, tracker = false, devices = false, health = false, lateness = false, levels = false,
             recorders = false, mark = false;
    };
    Fresh read();
    [[nodiscard]] bool next_event(EventTopic& event);
    [[nodiscard]] bool next_cycle(TraceTopic& cycle);
    // For a second reader with its own cursor.
    [[nodiscard]] bool next_cycle(RingCursor& place, TraceTopic& cycle) const;
    [[nodiscard]] std::uint64_t cycles_missed() const { return trace_cursor_.missed; }

    [[nodiscard]] bool attached() const { return !region_.empty(); }
    [[nodiscard]] const std::string& status_text() const {
        return refusal_.empty() ? link_.status_text() : refusal_;
    }
    // The bone of a drilling scene; empty() if there is none or bone_refusal() names an error. The mapping is stable
    // until poll() reports that the controller left or another one arrived.
    [[nodiscard]] const MappedBoneRegion& bone() const { return bone_; }
    [[nodiscard]] const std::string& bone_refusal() const { return bone_refusal_; }
    [[nodiscard]] std::uint64_t refused() const { return refused_; }
    [[nodiscard]] std::uint64_t events_missed() const { return cursor_.missed; }

    // The current level of one path; null if it is unknown.
    [[nodiscard]] const PathLevel* level(const char* path) const;

    // A recording is shown, by tact-replay.
    [[nodiscard]] bool replays() const { return attached() && have_replay; }
    // The clock of the topics: this process's, or that of the instant that a replay shows.
    [[nodiscard]] std::int64_t time_ns(std::int64_t now_ns) const;
    // How fast that clock runs: 1, or the speed of a replay, or 0 where it waits.
    [[nodiscard]] double time_rate() const;

    // Path of the controller's scene; empty while unknown.
    [[nodiscard]] std::string scene_path() const;
    // Of the controller's region; 0: not attached.
    [[nodiscard]] std::uint64_t generation() const { return region_.empty() ? 0 : region_.generation(); }
    [[nodiscard]] std::uint64_t scene_checksum() const {
        return region_.empty() ? 0 : region_->scene_checksum;
    }

    bool have_tool = false, have_second = false, have_bodies = false, have_shapes = false, have_touch = false,
         have_drill = false, have_head = false, have_tracker = false, have_devices = false,
         have_health = false, have_lateness = false, have_levels = false, have_recorders = false,
         have_mark = false, have_mouse = false, have_replay = false, have_replay_marks = false;
    ToolTopic tool{}, second{};  // the first hand, and the second one if present
    BodiesTopic bodies{};
    ShapesTopic shapes{};
    TouchTopic touch{};
    DrillTopic drill{};
    HeadTopic head{};
    TrackerTopic tracker{};
    DevicesTopic devices{};
    HealthTopic health{};
    LatenessTopic lateness{};
    RecordersTopic recorders{};
    MarkTopic mark{};
    MouseStateTopic mouse{};
    ReplayTopic replay{};
    ReplayMarks replay_marks{};
    LevelsTopic levels{};

private:
    template <class T>
    bool take(const Latest<T>& latest, std::uint64_t& seen, T& value, bool& have);

    LinkClient link_;
    MappedRegion<RtRegion> region_;
    MappedBoneRegion bone_;
    std::string refusal_, bone_refusal_;
    RingCursor cursor_, trace_cursor_;
    std::uint64_t seen_tool_ = 0, seen_second_ = 0, seen_bodies_ = 0, seen_shapes_ = 0, seen_touch_ = 0,
                  seen_drill_ = 0, seen_head_ = 0, seen_tracker_ = 0, seen_devices_ = 0, seen_health_ = 0,
                  seen_lateness_ = 0, seen_levels_ = 0, seen_recorders_ = 0, seen_mark_ = 0, seen_mouse_ = 0,
                  seen_replay_ = 0, seen_replay_marks_ = 0;
    bool watches_;
    std::uint64_t refused_ = 0;
};

}  // namespace tact
