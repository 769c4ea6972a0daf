// Making a thread and its process fit for real time, as far as this machine permits.
//
// Refused  every step that is refused is a finding: what was tried, why it failed, the command that fixes it,
//          and how the run goes on. Nothing here is fatal; what was reached is shown in the health topic.
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
    std::vector<std::string> findings;  // degraded, in words, each with its fix
    int dma_latency_fd = -1;            // kept open while the loop runs
};

struct ScheduleRequest {
    int priority = kServoPriority;  // FIFO; 0: ordinary
    int core = -1;                  // -1: chosen here; -2: not pinned
    bool lock_memory = true;
    bool limit_processor_time = true;  // RLIMIT_RTTIME; off for a loop that never sleeps
};

// malloc that gives nothing back and maps nothing, memory locked, wake-up latency of the processor held down.
void prepare_process(const ScheduleRequest& request, Platform& platform);
// Scheduling class, core, signal mask, touched stack. No allocation afterwards on this thread.
void prepare_thread(const ScheduleRequest& request, Platform& platform);
// Off the core that the servo is pinned to where there is another, no signals.
void prepare_helper_thread(const char* name, int servo_thread_id);
// A thread that may take its time: the same, below ordinary priority.
void prepare_builder_thread(int servo_thread_id);
void release_process(Platform& platform);

// Whether a list of the kernel ("0-2,5") has that core.
[[nodiscard]] bool in_cpu_list(const std::string& list, int cpu);

// Minor and major faults of the calling thread so far: a system call, so not within cycles.
[[nodiscard]] std::uint64_t own_page_faults() noexcept;
// The same of another thread of this process, from /proc; 0 where it cannot be read.
[[nodiscard]] std::uint64_t page_faults_of(int thread_id);

}  // namespace tact
