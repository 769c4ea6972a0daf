// The regions of every run, with their topics in order. For bone see ipc/topics/bone_region.hpp.
//
// tact.rt   written by tact-rt, read by tact-gui, tact and the recorder
// tact.gui  written by tact-gui, read by tact-rt
#pragma once

#include "ipc/shm/latest.hpp"
#include "ipc/shm/ring.hpp"
#include "ipc/shm/topic_list.hpp"
#include "ipc/topics/bodies.hpp"
#include "ipc/topics/command_queue.hpp"
#include "ipc/topics/device.hpp"
#include "ipc/topics/drill.hpp"
#include "ipc/topics/event.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/head.hpp"
#include "ipc/topics/health.hpp"
#include "ipc/topics/levels.hpp"
#include "ipc/topics/load.hpp"
#include "ipc/topics/mark.hpp"
#include "ipc/topics/mouse.hpp"
#include "ipc/topics/record.hpp"
#include "ipc/topics/recorders.hpp"
#include "ipc/topics/replay.hpp"
#include "ipc/topics/shapes.hpp"
#include "ipc/topics/tool.hpp"
#include "ipc/topics/touch.hpp"

namespace tact {

inline constexpr std::size_t kHandsMax = 2;
static_assert(kDrillHands == kHandsMax && kDeviceHands == kHandsMax && kMouseHands == kHandsMax);

struct RtRegion {
    static constexpr char kName[] = "tact.rt";
    Latest<ToolTopic> tool[kHandsMax];
    Latest<BodiesTopic> bodies;
    Latest<ShapesTopic> shapes;
    Latest<TouchTopic> touch;
    Latest<DrillTopic> drill;
    Latest<HeadTopic> head;
    Latest<TrackerTopic> tracker;
    Latest<DevicesTopic> devices;
    Latest<HealthTopic> health;
    Latest<LatenessTopic> lateness;
    Latest<LevelsTopic> levels;
    Latest<DisplayTopic> picture;
    Latest<RecordersTopic> recorders;
    Latest<MarkTopic> mark;
    Latest<MouseStateTopic> mouse;
    Latest<ReplayTopic> replay;  // of tact-replay alone
    Latest<ReplayMarks> replay_marks;
    Ring<EventTopic, 1024> events;
    Ring<TraceTopic, 16384> trace;
    // For recordings. At 1 kHz they hold half a minute.
    Latest<StartTopic> start;
    Ring<CycleTopic, 32768> cycles;
    Ring<HandTopic, 32768> hand[kHandsMax];
    Ring<MailboxTopic, 1024> mailbox;
    Ring<ReportTopic, 4096> reports;
    RunText run_text;      // written before ready
    char scene_path[512];  // of the loaded scene, ends with 0; written before ready
    std::uint64_t scene_checksum;
    std::uint64_t reserved[7];  // zero
    using Topics =
        TopicList<ToolTopic, BodiesTopic, ShapesTopic, TouchTopic, DrillTopic, HeadTopic, TrackerTopic,
                  DevicesTopic, HealthTopic, LatenessTopic, LevelsTopic, DisplayTopic, RecordersTopic,
                  MarkTopic, MouseStateTopic, ReplayTopic, ReplayMarks, EventTopic, TraceTopic, StartTopic,
                  CycleTopic, HandTopic, MailboxTopic, ReportTopic, RunText>;
};

struct GuiRegion {
    static constexpr char kName[] = "tact.gui";
    Latest<LoadTopic> load;
    Latest<FramesTopic> frames;
    Latest<TimelineTopic> timeline;  // for tact-replay
    Latest<MouseTopic> mouse;
    CommandQueue commands;
    using Topics = TopicList<LoadTopic, FramesTopic, TimelineTopic, MouseTopic, CommandTopic>;
};

}  // namespace tact
