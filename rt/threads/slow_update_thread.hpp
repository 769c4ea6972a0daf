// The thread that calls slow_update() of a model, for models that have one.
//
// Input     the tool state last published by the servo, extrapolated to now with its velocity
// Runs on   a thread of its own, off the servo's core if possible; every kSlowUpdatePeriod, or less often if it is late
// Thread    constructed and destroyed on main; the model must outlive it
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

    // One update at the given time.
    static void step(ForceModel& model, const Latest<ToolTopic>& tool, Instant now) noexcept;

private:
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
