// The thread that runs the servo loop: scheduled as asked, with a small stack that is locked and touched before the loop.
//
// Thread    start() and join() on one thread, that of the start-up
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
    // Stops the loop in order where that has not happened, so that nothing it uses goes before it.
    ~ServoThread();
    ServoThread(const ServoThread&) = delete;
    ServoThread& operator=(const ServoThread&) = delete;

    // Returns once the loop is warm; platform then says what was reached. Throws StartupError.
    void start();
    // Until the loop has ended.
    void join();

    // After start().
    [[nodiscard]] int id() const { return id_; }
    [[nodiscard]] std::uint64_t faults_at_start() const {
        return faults_at_start_;
    }  // page faults before the loop

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
