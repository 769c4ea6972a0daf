#include "rt/threads/servo_thread.hpp"

#include <unistd.h>

#include <cstring>

#include "ipc/base/error.hpp"

namespace tact {

ServoThread::~ServoThread() {
    if (!started_) return;
    int none = 0;
    mailbox_.stop_signal.compare_exchange_strong(none, -1, std::memory_order_relaxed);
    join();
}

void* ServoThread::body(void* self) {
    ServoThread& t = *static_cast<ServoThread*>(self);
    prepare_thread(t.request_, t.platform_);
    t.servo_.set_schedule_flags(t.platform_.flags);
    t.id_ = gettid();
    t.servo_.warm_up();
    t.faults_at_start_ = own_page_faults();
    t.running_.store(1, std::memory_order_release);
    t.running_.notify_one();
    t.servo_.run();
    t.servo_.publish_end(own_page_faults() - t.faults_at_start_);
    t.mailbox_.ended.store(true, std::memory_order_release);
    return nullptr;
}

void ServoThread::start() {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, 1024 * 1024);
    const int error = pthread_create(&handle_, &attributes, &body, this);
    pthread_attr_destroy(&attributes);
    if (error != 0) throw StartupError("starting the servo thread", std::strerror(error), "free some memory");
    started_ = true;
    running_.wait(0, std::memory_order_acquire);
}

void ServoThread::join() {
    started_ = false;
    pthread_join(handle_, nullptr);
}

}  // namespace tact
