// How long work tells how far it is, and how it is stopped.
#pragma once

#include <functional>

namespace tact {

// Called from time to time with the fraction done, in [0, 1], and what is being done. Returning false
// cancels: the callee throws Cancelled and leaves nothing half written.
using Progress = std::function<bool(double fraction, const char* what)>;

struct Cancelled {};

inline void report(const Progress& progress, double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Cancelled{};
}

// A part of the whole work tells its own fraction.
inline Progress part(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [whole, from, to](double fraction, const char* what) {
        return whole(from + fraction * (to - from), what);
    };
}

}  // namespace tact
