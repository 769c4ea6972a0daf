// Progress display and cancellation of tact-prep.
//
// On a terminal: one line that is overwritten, with an estimate of the time left. Elsewhere: one line for each
// kind of work and each twentieth of the whole, "[ 45 %] simplify", so that logs stay short. Ctrl-C and SIGTERM make
// the next report() cancel.
#pragma once

#include <chrono>
#include <string>

#include "ipc/base/progress.hpp"

namespace tact {

class Console {
public:
    Console();
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    [[nodiscard]] Progress progress();
    [[nodiscard]] static bool cancelled();
    // Erases the progress line, so that the next output begins at the left.
    void clear();

private:
    bool show(double fraction, const char* what);
    bool terminal_;
    bool drawn_ = false;
    std::string last_;
    double told_ = 0.0;  // fraction of the last line, if not a terminal
    std::chrono::steady_clock::time_point started_, drawn_at_;
};

}  // namespace tact
