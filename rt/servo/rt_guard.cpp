#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>

#include "ipc/base/rt.hpp"
#include "rt/servo/rt_guard.hpp"

namespace tact::rt_guard {

namespace {

constinit std::atomic<std::uint64_t> allocations{0};
constinit std::atomic<std::uint64_t> locks{0};
constinit std::atomic<bool> aborts{false};

void violation(const char* what) noexcept {
    // No stdio here: it allocates, and a lock may be held.
    rt_section_depth = 0;
    const char begin[] = "rt_guard: inside a servo cycle: ";
    static_cast<void>(!write(STDERR_FILENO, begin, sizeof begin - 1));
    static_cast<void>(!write(STDERR_FILENO, what, std::strlen(what)));
    static_cast<void>(!write(STDERR_FILENO, "\n", 1));
    std::abort();
}

}  // namespace

Counts counts() noexcept {
    return {allocations.load(std::memory_order_relaxed), locks.load(std::memory_order_relaxed)};
}
void abort_on_violation(bool on) noexcept { aborts.store(on, std::memory_order_relaxed); }

void seen_allocation(const char* what) noexcept {
    allocations.fetch_add(1, std::memory_order_relaxed);
    if (aborts.load(std::memory_order_relaxed)) violation(what);
}
void seen_lock(const char* what) noexcept {
    locks.fetch_add(1, std::memory_order_relaxed);
    if (aborts.load(std::memory_order_relaxed)) violation(what);
}

}  // namespace tact::rt_guard
