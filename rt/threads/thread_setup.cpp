#include "rt/threads/thread_setup.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "ipc/base/fifo.hpp"
#include "ipc/base/rights.hpp"
#include "ipc/topics/health.hpp"

namespace tact {

namespace {

std::string limit_text(rlim_t v, double unit, const char* name) {
    if (v == RLIM_INFINITY) return "unlimited";
    std::ostringstream out;
    out << static_cast<double>(v) / unit << name;
    return out.str();
}

// The last number of a kernel cpu list such as "2-3,6"; -1 if empty.
int last_cpu(const std::string& list) {
    const auto digit = list.find_last_of("0123456789");
    if (digit == std::string::npos) return -1;
    auto begin = digit;
    while (begin > 0 && list[begin - 1] >= '0' && list[begin - 1] <= '9') --begin;
    return std::stoi(list.substr(begin, digit - begin + 1));
}

std::string first_line(const char* path) {
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    return line;
}

void lock_memory(Platform& platform) {
    // Locks future pages only if the limit is infinite: with a small limit, later maps of this process would fail.
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    const bool unlimited = limit.rlim_cur == RLIM_INFINITY || geteuid() == 0;
    if (mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0) {
        platform.flags |= kScheduleLocked;
        return;
    }
    platform.findings.push_back(
        "cannot lock memory (" + std::string(std::strerror(errno)) + "; RLIMIT_MEMLOCK is " +
        limit_text(limit.rlim_cur, 1024.0 * 1024.0, " MiB") +
        "). Continuing with touched pages that may be swapped out.\n  fix: " + kLimitsFix);
}

void hold_dma_latency(Platform& platform) {
    const int fd = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    const std::int32_t zero = 0;
    if (fd >= 0 && write(fd, &zero, sizeof zero) == sizeof zero) {
        platform.dma_latency_fd = fd;
        platform.flags |= kScheduleDmaLatency;
        return;
    }
    const std::string why = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    platform.findings.push_back(
        "cannot hold /dev/cpu_dma_latency at 0 (" + why +
        "). Continuing; a sleeping core may wake up to 100 us late.\n  fix: " + kLimitsFix);
}

void take_fifo(const ScheduleRequest& request, Platform& platform) {
    if (request.priority <= 0) return;
    if (std::string refused = raise_to_fifo(pthread_self(), "the servo", request.priority);
        !refused.empty()) {
        platform.findings.push_back(std::move(refused));
        return;
    }
    platform.flags |= kScheduleFifo;
    if (request.limit_processor_time) {
        // Protects the machine from a runaway loop: SIGXCPU after 1 s, which ends the run in order.
        const rlimit limit{1'000'000, 2'000'000};
        setrlimit(RLIMIT_RTTIME, &limit);
    }
}

void pin(const ScheduleRequest& request, Platform& platform) {
    const std::string isolated = first_line("/sys/devices/system/cpu/isolated");
    int core = request.core;
    // Without FIFO, do not pin: the thread could not move away from other threads on its core.
    if (core == -1) core = last_cpu(isolated);
    if (core == -1 && (platform.flags & kScheduleFifo) != 0) {
        cpu_set_t allowed;
        CPU_ZERO(&allowed);
        sched_getaffinity(0, sizeof allowed, &allowed);
        for (int i = 0; i < CPU_SETSIZE; ++i) {
            if (CPU_ISSET(static_cast<std::size_t>(i), &allowed)) core = i;
        }
    }
    if (core < 0) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    if (core < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(core), &set);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    if (error != 0) {
        platform.findings.push_back("cannot pin the servo to core " + std::to_string(core) + " (" +
                                    std::strerror(error) +
                                    "). Continuing on the core that the kernel chooses.\n  fix: choose "
                                    "one of " +
                                    first_line("/sys/devices/system/cpu/online") + " with --core");
        return;
    }
    platform.flags |= kSchedulePinned;
    if (in_cpu_list(isolated, core)) platform.flags |= kScheduleIsolated;
}

void warn_of_throttling(Platform& platform) {
    const std::string runtime = first_line("/proc/sys/kernel/sched_rt_runtime_us");
    if (runtime.empty() || runtime == "-1") return;
    platform.findings.push_back("the kernel throttles a FIFO loop that never sleeps: it takes " +
                                std::to_string(1'000'000 - std::stol(runtime)) +
                                " us of every second from it.\n  fix: reduce servo.spin_us, choose a fixed "
                                "rate, or set --priority 0");
}

// Touches the stack below this frame, so that its pages are resident before the loop starts.
[[gnu::noinline]] void touch_stack() {
    constexpr std::size_t kBytes = 192 * 1024;
    unsigned char block[kBytes];
    for (std::size_t i = 0; i < kBytes; i += 1024) block[i] = 0;
    asm volatile("" : : "r"(block) : "memory");  // keeps the stores
}

}  // namespace

bool in_cpu_list(const std::string& list, int cpu) {
    std::istringstream in(list);
    for (std::string part; std::getline(in, part, ',');) {
        int low = 0, high = 0;
        char dash = 0;
        std::istringstream range(part);
        if (!(range >> low)) continue;
        high = range >> dash >> high ? high : low;
        if (cpu >= low && cpu <= high) return true;
    }
    return false;
}

void prepare_process(const ScheduleRequest& request, Platform& platform) {
    mallopt(M_TRIM_THRESHOLD, -1);
    mallopt(M_MMAP_MAX, 0);
    if (request.lock_memory) lock_memory(platform);
    hold_dma_latency(platform);
}

void prepare_thread(const ScheduleRequest& request, Platform& platform) {
    sigset_t all;
    sigfillset(&all);
    sigdelset(&all, SIGXCPU);  // sent for this thread's processor time
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    pthread_setname_np(pthread_self(), "servo");
    take_fifo(request, platform);
    pin(request, platform);
    if ((platform.flags & kScheduleFifo) != 0 && !request.limit_processor_time) warn_of_throttling(platform);
    touch_stack();
}

void prepare_builder_thread(int servo_thread_id) {
    prepare_helper_thread("builder", servo_thread_id);
    // On Linux niceness is per thread. A refusal only costs some fairness.
    static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10));
}

void prepare_helper_thread(const char* name, int servo_thread_id) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    pthread_setname_np(pthread_self(), name);
    cpu_set_t servo, own;
    CPU_ZERO(&servo);
    CPU_ZERO(&own);
    if (sched_getaffinity(servo_thread_id, sizeof servo, &servo) != 0 || CPU_COUNT(&servo) != 1) return;
    if (sched_getaffinity(0, sizeof own, &own) != 0) return;
    cpu_set_t rest;
    CPU_ZERO(&rest);
    for (std::size_t i = 0; i < CPU_SETSIZE; ++i) {
        if (CPU_ISSET(i, &own) && !CPU_ISSET(i, &servo)) CPU_SET(i, &rest);
    }
    if (CPU_COUNT(&rest) > 0) static_cast<void>(sched_setaffinity(0, sizeof rest, &rest));
}

void release_process(Platform& platform) {
    if (platform.dma_latency_fd >= 0) ::close(platform.dma_latency_fd);
    platform.dma_latency_fd = -1;
}

std::uint64_t own_page_faults() noexcept {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return static_cast<std::uint64_t>(usage.ru_minflt) + static_cast<std::uint64_t>(usage.ru_majflt);
}

std::uint64_t page_faults_of(int thread_id) {
    std::ifstream in("/proc/self/task/" + std::to_string(thread_id) + "/stat");
    std::string line;
    std::getline(in, line);
    // After the name in brackets: state ppid pgrp session tty tpgid flags minflt cminflt majflt
    const auto after = line.rfind(')');
    if (after == std::string::npos) return 0;
    std::istringstream fields(line.substr(after + 1));
    std::string skip;
    std::uint64_t minor = 0, children = 0, major = 0;
    for (int i = 0; i < 7; ++i) fields >> skip;
    fields >> minor >> children >> major;
    return fields ? minor + major : 0;
}

}  // namespace tact
