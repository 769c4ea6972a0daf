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
    pthread_attr_setstacksize(&attributes, std::size_t{1} << 20);  // small, because all of it is locked
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

// Release: passes earlier writes to the other thread; pairs with the acquire loads.
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
        failure_ = "the model has nothing to rebuild";
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
        if (!mailbox_.model.offer(model_)) return;  // retry in the next poll
        spdlog::info("rebuilt the force model in {:.2f} s", took_s_);
        turn(State::idle);
    } else if (s == State::done) {
        spdlog::error("could not rebuild the force model: {}\n  the old model stays in use", failure_);
        mailbox_.build.refuse();
        turn(State::idle);
    }
}

}  // namespace tact
