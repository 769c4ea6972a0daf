// The thread of the servo loop: scheduled as requested, with a small stack that is locked and touched before the loop.
//
// Thread    start() and join() on the start-up thread
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>

#include "rt/servo/servo.hpp"
#include "rt/threads/thread_setup.hpp"

namespace tact {

class ServoThread {
public:
    ServoThread(Servo& servo, const ScheduleRequest& request, Platform& platform, ServoMailbox& mailbox)
        : servo_(servo), request_(request), platform_(platform), mailbox_(mailbox) {}
    // Stops the loop if it still runs, so that it ends before the objects that it uses.
    ~ServoThread();
    ServoThread(const ServoThread&) = delete;
    ServoThread& operator=(const ServoThread&) = delete;

    // Returns after the warm-up; `platform` then holds the result of the thread setup. Throws StartupError.
    void start();
    // Returns when the loop has ended.
    void join();

    // After start().
    [[nodiscard]] int id() const { return id_; }
    // Page faults before the loop.
    [[nodiscard]] std::uint64_t faults_at_start() const { return faults_at_start_; }

private:
    static void* body(void* self);

    Servo& servo_;
    ScheduleRequest request_;
    Platform& platform_;
    ServoMailbox& mailbox_;
    std::atomic<int> running_{0};
    int id_ = 0;
    std::uint64_t faults_at_start_ = 0;
    pthread_t handle_{};
    bool started_ = false;
};

}  // namespace tact
