#include "rt/threads/slow_update_thread.hpp"

#include <algorithm>
#include <csignal>

#include "ipc/base/servo_clock.hpp"
#include "rt/threads/thread_setup.hpp"

namespace tact {
namespace {

constexpr double kPredictedMaxS = 0.01;  // longest extrapolation of a sample

}  // namespace

SlowUpdateThread::SlowUpdateThread(ForceModel& model, const Latest<ToolTopic>& tool, int servo_thread_id) {
    // The new thread inherits a mask that blocks all signals; main handles them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this, &model, &tool, servo_thread_id] {
        prepare_helper_thread("slow-update", servo_thread_id);
        ServoClock clock(Duration{0});
        Instant next = clock.now();
        while (!leave_.load(std::memory_order_relaxed)) {
            step(model, tool, clock.now());
            next = std::max(next + kSlowUpdatePeriod, clock.now());
            clock.wait_until(next);
        }
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

SlowUpdateThread::~SlowUpdateThread() {
    leave_.store(true, std::memory_order_relaxed);
    thread_.join();
}

void SlowUpdateThread::step(ForceModel& model, const Latest<ToolTopic>& tool, Instant now) noexcept {
    ToolTopic t{};
    if (!tool.read(t)) return;
    ToolState state;
    const double age_s =
        std::clamp(1e-9 * static_cast<double>(to_ns(now) - t.taken_at_ns), 0.0, kPredictedMaxS);
    for (Eigen::Index i = 0; i < 3; ++i) {
        state.twist_world.linear_m_s[i] = t.velocity_world_m_s[i];
        state.T_world_tool.p_m[i] = t.pos_world_m[i] + age_s * t.velocity_world_m_s[i];
    }
    state.T_world_tool.q = Quat(t.quat_world_tool_xyzw[3], t.quat_world_tool_xyzw[0],
                                t.quat_world_tool_xyzw[1], t.quat_world_tool_xyzw[2]);
    state.buttons = t.buttons;
    model.slow_update(state, {});
}

}  // namespace tact
