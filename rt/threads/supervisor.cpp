#include "rt/threads/supervisor.hpp"

#include <pthread.h>
#include <sched.h>

#include <utility>

#include "ipc/base/servo_clock.hpp"
#include "rt/threads/thread_setup.hpp"

namespace tact {

bool Supervision::check(Instant beat, bool enabled, std::uint64_t rearms, Instant now) noexcept {
    if (dropped_ && rearms != rearms_) dropped_ = false;
    rearms_ = rearms;
    if (dropped_ || !enabled || now - beat <= silence_max_) return false;
    dropped_ = true;
    ++drops_;
    return true;
}

Supervisor::Supervisor(ServoPulse& pulse, Duration silence_max, std::function<void()> drop)
    : pulse_(pulse), supervision_(silence_max), drop_(std::move(drop)) {}

Supervisor::~Supervisor() {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

void Supervisor::start(int servo_thread_id) {
    thread_ = std::thread([this, servo_thread_id] {
        prepare_helper_thread("supervisor", servo_thread_id);
        sched_param param{};
        param.sched_priority = kPriority;
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);  // ordinary scheduling if not permitted
        ServoClock clock(Duration{0});
        while (!leave_.load(std::memory_order_relaxed)) {
            // Acquire: the beat read below is at least as new as this enable; pairs with the servo's store.
            const bool enabled = pulse_.enabled.load(std::memory_order_acquire);
            const Instant beat = instant_from_ns(pulse_.beat_ns.load(std::memory_order_relaxed));
            const std::uint64_t rearms = pulse_.rearms.load(std::memory_order_acquire);
            if (supervision_.check(beat, enabled, rearms, clock.now())) {
                drop_();
                pulse_.drops.store(supervision_.drops(), std::memory_order_release);
            }
            clock.wait_until(clock.now() + kEvery);
        }
    });
}

}  // namespace tact
