#include "rt/threads/model_builder.hpp"

#include <spdlog/spdlog.h>

#include <cstring>
#include <exception>

#include "ipc/base/error.hpp"
#include "rt/threads/thread_setup.hpp"

namespace tact {

ModelBuilder::ModelBuilder(ServoMailbox& mailbox, int servo_thread_id)
    : mailbox_(mailbox), servo_thread_id_(servo_thread_id) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, std::size_t{1} << 20);  // it is locked as a whole
    const int error = pthread_create(&thread_, &attributes, &body, this);
    pthread_attr_destroy(&attributes);
    if (error != 0)
        throw StartupError("starting the thread that builds models", std::strerror(error),
                           "free some memory");
}

ModelBuilder::~ModelBuilder() {
    while (state_.load(std::memory_order_acquire) == State::work) state_.wait(State::work);
    turn(State::quit);
    pthread_join(thread_, nullptr);
}

// Release: what was written before is the other side's from now on; pairs with the loads that acquire.
void ModelBuilder::turn(State to) noexcept {
    state_.store(to, std::memory_order_release);
    state_.notify_all();
}

void* ModelBuilder::body(void* self) {
    ModelBuilder& b = *static_cast<ModelBuilder*>(self);
    prepare_builder_thread(b.servo_thread_id_);
    for (State s = b.state_.load(std::memory_order_acquire); s != State::quit;
         s = b.state_.load(std::memory_order_acquire)) {
        if (s == State::work) {
            b.build();
            b.turn(State::done);
        } else {
            b.state_.wait(s);
        }
    }
    return nullptr;
}

void ModelBuilder::build() noexcept {
    const Instant begin = Monotonic::now();
    try {
        failure_ = "there is nothing to build";
        model_ = mailbox_.build.like().rebuild(mailbox_.build.bodies());
    } catch (const std::exception& e) {
        failure_ = e.what();
    }
    took_s_ = to_s(Monotonic::now() - begin);
}

void ModelBuilder::poll() {
    const State s = state_.load(std::memory_order_acquire);
    if (s == State::idle && mailbox_.build.take()) {
        turn(State::work);
    } else if (s == State::done && model_ != nullptr) {
        if (!mailbox_.model.offer(model_)) return;  // next turn
        spdlog::info("built another force model in {:.2f} s", took_s_);
        turn(State::idle);
    } else if (s == State::done) {
        spdlog::error("could not build another force model: {}\n  the one before goes on", failure_);
        mailbox_.build.refuse();
        turn(State::idle);
    }
}

}  // namespace tact
