#include "gui/window/stop_signal.hpp"

#include <csignal>

namespace tact {
namespace {

volatile std::sig_atomic_t stop_number = 0;
void keep_number(int number) { stop_number = number; }

}  // namespace

void catch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = keep_number;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGHUP, &action, nullptr);
}

int stop_signal() noexcept { return stop_number; }

}  // namespace tact
