// Counts what the servo thread must not do: heap and mutex calls while it is inside a cycle (RtSection).
//
// How      interpose.cpp defines malloc, calloc, realloc, free, the aligned ones and pthread_mutex_lock in
//          the program itself, so that calls from inside shared libraries are seen too; each forwards to
//          libc.
// Linked   into tact-rt and tests/rt_safe, which list interpose.cpp. Not under sanitizers, which own malloc.
// Modes    count (tact-rt; shown in the health topic) or abort with a message (tests/rt_safe)
#pragma once

#include <cstdint>

namespace tact::rt_guard {

struct Counts {
    std::uint64_t allocations = 0;  // malloc, calloc, realloc, free and their like
    std::uint64_t locks = 0;        // pthread_mutex_lock
};

[[nodiscard]] Counts counts() noexcept;
// Defined beside the interposers: naming it links them in. False under sanitizers.
bool install() noexcept;
void abort_on_violation(bool on) noexcept;

// Called by the interposers.
void seen_allocation(const char* what) noexcept;
void seen_lock(const char* what) noexcept;

}  // namespace tact::rt_guard
