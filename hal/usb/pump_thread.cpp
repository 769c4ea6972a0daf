#include "hal/usb/pump_thread.hpp"

#include <pthread.h>

#include <utility>

#include "ipc/base/fifo.hpp"
#include "ipc/base/quiet_thread.hpp"

namespace tact::usb {

std::string PumpThread::start(std::function<void()> run, const char* name, const char* what, int priority) {
    thread_ = start_quiet_thread([run = std::move(run), name] {
        pthread_setname_np(pthread_self(), name);
        run();
    });
    return raise_to_fifo(thread_.native_handle(), what, priority);
}

void PumpThread::stop() noexcept {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

}  // namespace tact::usb
