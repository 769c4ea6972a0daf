// What a person sees while tact-prep works, and how they stop it.
//
// On a terminal one line that is written over, with an estimate of the time left; elsewhere one line for each
// kind of work and each twentieth of the whole, "[ 45 %] simplify", so that a log stays short. Ctrl-C and SIGTERM make
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
    // Removes the unfinished line, so that what follows begins at the left.
    void clear();

private:
    bool show(double fraction, const char* what);
    bool terminal_;
    bool drawn_ = false;
    std::string last_;
    double told_ = 0.0;  // elsewhere
    std::chrono::steady_clock::time_point started_, drawn_at_;
};

}  // namespace tact
