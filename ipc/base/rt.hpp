// Annotations of the servo path.
//
// TACT_RT marks a function as suitable for the servo thread: it never allocates, blocks or throws.
// Compilers with the attribute (clang >= 20) check this; otherwise tests/rt_safe does. RtSection is the
// annotation at run time: while one exists, the calling thread is inside a servo cycle, and the allocation
// and lock counters of rt/servo/rt_guard.cpp count, or abort in tests.
#pragma once

#include <cstdint>

#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define TACT_RT [[clang::nonblocking]]
#endif
#endif
#ifndef TACT_RT
#define TACT_RT
#endif

namespace tact {

// constinit keeps the access a plain load: no guard, no allocation at first use.
inline constinit thread_local int rt_section_depth = 0;

class RtSection {
public:
    RtSection() noexcept { ++rt_section_depth; }
    ~RtSection() { --rt_section_depth; }
    RtSection(const RtSection&) = delete;
    RtSection& operator=(const RtSection&) = delete;
};

}  // namespace tact
