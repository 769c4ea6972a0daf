// A region as written by a controller with two devices, a tracker and a window. For tests of the metrics.
#pragma once

#include <cstring>
#include <memory>

#include "ipc/base/histogram.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::launch {

inline std::unique_ptr<RtRegion> a_region() {
    auto region = std::make_unique<RtRegion>();
    HealthTopic h{};
    h.force_rate_hz = 998.5;
    h.goal_hz = 1000.0;
    h.overruns = 3;
    h.state = static_cast<std::uint8_t>(RunState::active);
    h.gui_fps = 50.0;
    h.gui_attached = 1;
    h.device_bus[0].lost = 7;
    h.delay_p99_ns = 900'000;
    region->health.publish(h);
    LatenessTopic l{};
    for (const std::uint64_t ns : {300U, 400U, 1500U, 30'000U, 40'000'000U}) {
        ++l.counts[DurationHistogram::bucket_of(ns)];
        ++l.total;
    }
    region->lateness.publish(l);
    LevelsTopic levels{};
    levels.count = 1;
    std::strcpy(levels.path[0].path, "docking.force");
    levels.path[0].level = 0.25F;
    region->levels.publish(levels);
    DevicesTopic devices{};
    devices.hand[0].valid = 1;
    devices.hand[0].heat = 0.5F;
    devices.hand[0].force_n_continuous = 1.4F;
    devices.hand[1].valid = 1;
    devices.hand[1].winding_c = 60.0F;
    devices.hand[1].winding_c_max = 120.0F;
    devices.hand[1].age_ns_most = 1000;
    region->devices.publish(devices);
    TrackerTopic tracker{};
    tracker.state = 2;
    tracker.missed = 4;
    region->tracker.publish(tracker);
    DisplayTopic picture{};
    picture.taken_at_ns = 1;
    picture.metrics.frames = 400;
    picture.metrics.late = 2;
    picture.metrics.due_s = 0.02;
    picture.metrics.p50_s = 0.5F;
    picture.metrics.p99_s = picture.metrics.most_s = 0.75F;
    for (PassMetrics& p : picture.metrics.pass) p.drawn_p50_s = p.drawn_p99_s = -1.0F;
    picture.metrics.pass[static_cast<std::size_t>(Pass::bone)] = {0.125F, 0.25F, 0.375F, 0.5F};
    picture.metrics.path[1].work_p50_s = 0.0625F;
    picture.metrics.path[1].work_p99_s = 0.125F;
    region->picture.publish(picture);
    return region;
}

inline void fault(RtRegion& region, RunReason reason) {
    EventTopic e{};
    e.code = static_cast<std::uint16_t>(EventCode::fault_latched);
    e.a = static_cast<double>(reason);
    region.events.push(e);
}

}  // namespace tact::launch
