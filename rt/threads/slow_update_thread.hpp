// Calls the slow half of a model, for models that have one.
//
// Gives     the tool as the servo published it last, moved on by its velocity to now
// Runs on   a thread of its own, off the servo's core where there is another; kSlowUpdatePeriod, or as often as it gets through
// Thread    constructed and destroyed on main; the model outlives it
#pragma once

#include <atomic>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/tool.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class SlowUpdateThread {
public:
    SlowUpdateThread(ForceModel& model, const Latest<ToolTopic>& tool, int servo_thread_id);
    ~SlowUpdateThread();
    SlowUpdateThread(const SlowUpdateThread&) = delete;
    SlowUpdateThread& operator=(const SlowUpdateThread&) = delete;

    // Once, at a time.
    static void step(ForceModel& model, const Latest<ToolTopic>& tool, Instant now) noexcept;

private:
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
