// Loads a cache line some iterations before it is read.
//
// Without the empty assembly, GCC assumes that a function that only prefetches has no effect, and silently
// drops its calls and with them the prefetches (observed with GCC 12 at -O3).
#pragma once

#include "ipc/base/rt.hpp"

namespace tact {

[[gnu::always_inline]] inline void prefetch(const void* line) noexcept TACT_RT {
    __builtin_prefetch(line);
    asm volatile("");
}

[[gnu::always_inline]] inline void prefetch_to_write(const void* line) noexcept TACT_RT {
    __builtin_prefetch(line, 1);
    asm volatile("");
}

}  // namespace tact
