// Prepares a thread and its process for real time, as far as this machine permits.
//
// Refused  each refused step gives a finding: the step, the cause, the fix, and the consequence. No step is fatal; the
//          health topic shows the result.
// Thread   prepare_process() at start-up on the main thread, the others on the thread that they prepare
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct Platform {
    std::uint32_t flags = 0;            // ScheduleFlag
    std::vector<std::string> findings;  // messages about refused steps, each with its fix
    int dma_latency_fd = -1;            // open while the loop runs
};

struct ScheduleRequest {
    int priority = kServoPriority;  // FIFO; 0: ordinary
    int core = -1;                  // -1: automatic; -2: not pinned
    bool lock_memory = true;
    bool limit_processor_time = true;  // RLIMIT_RTTIME; off for a loop that never sleeps
};

// Makes malloc keep its memory and avoid mmap, locks memory, and limits the processor's wake-up latency.
void prepare_process(const ScheduleRequest& request, Platform& platform);
// Sets scheduling class, core and signal mask, and touches the stack. The thread must not allocate afterwards.
void prepare_thread(const ScheduleRequest& request, Platform& platform);
// Moves the thread off the servo's core if possible, and blocks signals.
void prepare_helper_thread(const char* name, int servo_thread_id);
// The same, below ordinary priority.
void prepare_builder_thread(int servo_thread_id);
void release_process(Platform& platform);

// True if a kernel cpu list ("0-2,5") contains the core.
[[nodiscard]] bool in_cpu_list(const std::string& list, int cpu);

// Minor and major page faults of the calling thread; a system call, so not within cycles.
[[nodiscard]] std::uint64_t own_page_faults() noexcept;
// The same for another thread of this process, from /proc; 0 if not readable.
[[nodiscard]] std::uint64_t page_faults_of(int thread_id);

}  // namespace tact
