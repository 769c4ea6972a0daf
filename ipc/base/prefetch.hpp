// Calls for a cache line some turns before it is read.
//
// The empty assembly is there because a function that only prefetches has no effect that GCC knows of: it drops the calls
// of such a function, and with them the prefetches, without a word (seen with GCC 12 at -O3).
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
