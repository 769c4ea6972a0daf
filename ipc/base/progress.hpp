// Progress reports of long work, and its cancellation.
#pragma once

#include <functional>

namespace tact {

// Called periodically with the completed fraction in [0, 1] and the current activity. Returning false
// cancels: the callee throws Cancelled and leaves no partial output.
using Progress = std::function<bool(double fraction, const char* what)>;

struct Cancelled {};

inline void report(const Progress& progress, double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Cancelled{};
}

// Maps the progress of a part to the range from..to of the whole.
inline Progress part(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [whole, from, to](double fraction, const char* what) {
        return whole(from + fraction * (to - from), what);
    };
}

}  // namespace tact
