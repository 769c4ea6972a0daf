// A tracker whose reader runs on a thread of its own: the part that trackers of all sources share.
//
// Thread   with the given name, FIFO 70 where permitted, else ordinary; never the servo's. It wakes for data or every
//          10 ms, and blocks all signals.
#pragma once

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "hal/api/tracker.hpp"
#include "ipc/base/quiet_thread.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

// Source: open(). Reader: made of settings, source and clock; opened(), round(patience), read() and health().
template <class Settings, class Source, class Reader>
class ThreadedTracker : public Tracker {
public:
    static constexpr int kPriority = 70;

    ~ThreadedTracker() override {
        leave_.store(true, std::memory_order_relaxed);
        if (thread_.joinable()) thread_.join();
    }
    ThreadedTracker(const ThreadedTracker&) = delete;
    ThreadedTracker& operator=(const ThreadedTracker&) = delete;

    TrackerInfo open() override {
        if (!thread_.joinable()) {
            source_->open();
            reader_.opened();
            thread_ = start_quiet_thread([this] { live(); });
        }
        return info_;
    }
    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT override {
        return reader_.read(sensor, newest, now);
    }
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT override { return reader_.health(); }

protected:
    // thread_name: a literal.
    ThreadedTracker(const Settings& settings, std::unique_ptr<Source> source, TrackerInfo info,
                    const char* thread_name)
        : info_(std::move(info)),
          thread_name_(thread_name),
          source_(std::move(source)),
          reader_(settings, *source_, clock_) {}

private:
    void live() noexcept {
        pthread_setname_np(pthread_self(), thread_name_);
        sched_param param{};
        param.sched_priority = kPriority;
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);  // without the right: ordinary scheduling
        while (!leave_.load(std::memory_order_relaxed)) reader_.round(std::chrono::milliseconds(10));
    }

    TrackerInfo info_;
    const char* thread_name_;
    std::unique_ptr<Source> source_;
    ServoClock clock_{Duration{0}};  // no spinning
    Reader reader_;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
