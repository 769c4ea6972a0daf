#include "prep/console/console.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

namespace tact {
namespace {

// Written by the signal handler.
std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int) { stop_asked.store(true, std::memory_order_relaxed); }

}  // namespace

Console::Console()
    : terminal_(::isatty(STDERR_FILENO) == 1),
      started_(std::chrono::steady_clock::now()),
      drawn_at_(started_) {
    struct sigaction action {};
    action.sa_handler = on_signal;
    // A second Ctrl-C ends the program at once; the output file is still either whole or absent.
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

Console::~Console() { clear(); }

Progress Console::progress() {
    return [this](double fraction, const char* what) { return show(fraction, what); };
}

bool Console::cancelled() { return stop_asked.load(std::memory_order_relaxed); }

void Console::clear() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
    drawn_ = false;
}

bool Console::show(double fraction, const char* what) {
    const auto now = std::chrono::steady_clock::now();
    const bool changed = last_ != what;
    const double done = std::clamp(fraction, 0.0, 1.0);
    if (terminal_ && (changed || now - drawn_at_ > std::chrono::milliseconds(100))) {
        const double spent_s = std::chrono::duration<double>(now - started_).count();
        // Early estimates fluctuate too much to be useful.
        char left[48] = "";
        if (done > 0.05 && spent_s > 1.0)
            std::snprintf(left, sizeof left, ", about %.0f s left", std::ceil(spent_s * (1.0 - done) / done));
        std::fprintf(stderr, "\r[%3.0f %%] %s%s\x1b[K", 100.0 * done, what, left);
        std::fflush(stderr);
        drawn_ = true;
        drawn_at_ = now;
    } else if (!terminal_ && (changed || done >= told_ + 0.05)) {
        std::fprintf(stderr, "[%3.0f %%] %s\n", std::floor(100.0 * done), what);
        told_ = done;
    }
    last_ = what;
    return !cancelled();
}

}  // namespace tact
