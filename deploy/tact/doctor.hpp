// Checks whether this machine can keep a steady force rate, with the fix of each finding.
//
// read_machine() gathers plain texts and numbers; judge() is pure, so that tests can use texts recorded on other
// machines.
// Levels    fail: Tact cannot run here. warn: it runs, but with a worse force rate or display. ok: as required.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "deploy/tact/rights.hpp"
#include "ipc/shm/servo_threads.hpp"

namespace tact::launch {

enum class FindingLevel : std::uint8_t { ok, warn, fail };

struct Finding {
    std::string name;  // stable, for programs: "kernel", "rtprio"
    FindingLevel level = FindingLevel::ok;
    std::string says;
    std::string fix;  // empty if nothing is to be fixed
};

// As the kernel reports it; "" if a file is missing.
struct Machine {
    std::string kernel_version;  // uname -v
    std::string realtime;        // /sys/kernel/realtime
    std::string isolated;        // /sys/devices/system/cpu/isolated
    std::string nohz_full;
    std::vector<std::string> governors;  // scaling_governor of each core
    std::string rt_runtime_us;           // /proc/sys/kernel/sched_rt_runtime_us
    std::string swaps;                   // /proc/swaps
    std::string huge_pages;              // /sys/kernel/mm/transparent_hugepage/enabled
    std::string clocksource;
    std::string cpuinfo;                  // /proc/cpuinfo
    std::string capabilities;             // /proc/self/status
    std::uint64_t rtprio_max = 0;         // RLIMIT_RTPRIO
    std::uint64_t memlock_bytes_max = 0;  // RLIMIT_MEMLOCK; all ones: no limit
    Person person;
    std::vector<PinnedServo> servos;  // running controllers
    int cores = 0;
    int fifo_error = 0;         // errno of requesting SCHED_FIFO; 0: granted
    int dma_latency_error = 0;  // errno of opening /dev/cpu_dma_latency for writing
};

Machine read_machine(const std::filesystem::path& root = "/");
std::vector<Finding> judge(const Machine& machine);

// Tests programs, folders, display, OpenGL and session by using them.
std::vector<Finding> try_surroundings(const std::string& session);
// Where windows open, from the values of DISPLAY and WAYLAND_DISPLAY; empty: not set.
Finding judge_display(const std::string& x, const std::string& wayland, bool xvfb);

// Parses "2-3,5" to core numbers; empty if the text is not such a list.
std::vector<int> parse_core_list(const std::string& text);
// Tests a bit of the effective capabilities in a /proc/<pid>/status text.
bool has_capability(const std::string& status, int bit);
// The word in brackets of "always [madvise] never"; "" if there is none.
std::string chosen_word(const std::string& text);
// Device names of /proc/swaps.
std::vector<std::string> parse_swaps(const std::string& text);

}  // namespace tact::launch
