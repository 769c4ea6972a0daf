// Rebuilds models for the servo, one at a time, on a thread of its own: another density may take seconds.
//
// Does      takes the servo's request from the mailbox, rebuilds the model, offers it to the servo
// Runs on   poll() on the housekeeping thread, without blocking it; the work on a thread below ordinary priority, off the
//           servo's core if possible
// Fails by  refusing the request, with the reason in the log; the model in use stays
// Ends      after the current work
#pragma once

#include <pthread.h>

#include <atomic>
#include <memory>
#include <string>

#include "rt/servo/mailbox.hpp"

namespace tact {

class ModelBuilder {
public:
    ModelBuilder(ServoMailbox& mailbox, int servo_thread_id);  // starts the thread; throws StartupError
    ~ModelBuilder();
    ModelBuilder(const ModelBuilder&) = delete;
    ModelBuilder& operator=(const ModelBuilder&) = delete;

    // Housekeeping thread, every loop.
    void poll();

private:
    enum class State : int { idle, work, done, quit };
    static void* body(void* self);
    void build() noexcept;
    void turn(State to) noexcept;

    ServoMailbox& mailbox_;
    int servo_thread_id_;
    std::atomic<State> state_{State::idle};
    // Owned by the builder thread in state `work`, else by the housekeeping thread.
    std::unique_ptr<ForceModel> model_;
    std::string failure_;
    double took_s_ = 0.0;
    pthread_t thread_{};
};

}  // namespace tact
