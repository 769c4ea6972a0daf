// Counts forbidden calls of the servo thread: heap and mutex calls inside a cycle (RtSection).
//
// How      interpose.cpp defines malloc, calloc, realloc, free, the aligned variants and pthread_mutex_lock in
//          the program, so that calls from shared libraries count too; each forwards to libc.
// Linked   into tact-rt and tests/rt_safe, which list interpose.cpp. Not under sanitizers, which replace malloc.
// Modes    count (tact-rt; published in the health topic) or abort with a message (tests/rt_safe)
#pragma once

#include <cstdint>

namespace tact::rt_guard {

struct Counts {
    std::uint64_t allocations = 0;  // malloc, calloc, realloc, free and aligned variants
    std::uint64_t locks = 0;        // pthread_mutex_lock
};

[[nodiscard]] Counts counts() noexcept;
// Defined with the interposers, so that a call links them in. False under sanitizers.
bool install() noexcept;
void abort_on_violation(bool on) noexcept;

// Called by the interposers.
void seen_allocation(const char* what) noexcept;
void seen_lock(const char* what) noexcept;

}  // namespace tact::rt_guard
