#include "deploy/tact/doctor.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <sstream>

#include "deploy/tact/files.hpp"
#include "ipc/base/fifo.hpp"
#include "ipc/base/rights.hpp"

namespace tact::launch {
namespace {

constexpr int kCapIpcLock = 14, kCapSysNice = 23;
constexpr std::uint64_t kMemlockWanted = 1ULL << 30;  // a scene with a large map, its spline and the program
constexpr std::uint64_t kNoLimit = ~0ULL;

std::string trimmed(const std::string& text) {
    const auto end = text.find_last_not_of(" \t\n");
    return end == std::string::npos ? "" : text.substr(0, end + 1);
}

int error_of_fifo() {
    const int policy = sched_getscheduler(0);
    sched_param before{}, wanted{};
    sched_getparam(0, &before);
    wanted.sched_priority = kSupervisorPriority;
    if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0) return errno;
    sched_setscheduler(0, policy, &before);
    return 0;
}

int error_of_dma_latency(const std::filesystem::path& path) {
    const int fd = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0) return errno;
    close(fd);  // nothing is written, so nothing changes
    return 0;
}

Finding ok(std::string name, std::string says) {
    return {std::move(name), FindingLevel::ok, std::move(says), ""};
}
Finding warn(std::string name, std::string says, std::string fix) {
    return {std::move(name), FindingLevel::warn, std::move(says), std::move(fix)};
}

Finding kernel(const Machine& m) {
    if (trimmed(m.realtime) == "1" || m.kernel_version.find("PREEMPT_RT") != std::string::npos)
        return ok("kernel", "real-time kernel: " + m.kernel_version);
    return warn(
        "kernel",
        "not a real-time kernel (" + m.kernel_version + "): single cycles may be late by milliseconds",
        "sudo apt-get install linux-image-rt-amd64; select it at the next boot");
}

Finding cores(const Machine& m) {
    if (m.cores >= 4) return ok("cores", std::to_string(m.cores) + " processor cores");
    return warn("cores",
                std::to_string(m.cores) + " processor cores: controller, window and system share them",
                "use a machine with four cores or more, one of them kept for the controller");
}

Finding isolation(const Machine& m) {
    const auto isolated = parse_core_list(m.isolated);
    const auto quiet = parse_core_list(m.nohz_full);
    if (isolated.empty()) {
        const std::string core = std::to_string(std::max(m.cores - 1, 1));
        return warn("isolation", "no core is kept free for the servo thread",
                    "add to GRUB_CMDLINE_LINUX in /etc/default/grub: isolcpus=managed_irq,domain," + core +
                        " nohz_full=" + core + " rcu_nocbs=" + core +
                        " irqaffinity=0; sudo update-grub; restart; run with --core " + core);
    }
    const std::string first = std::to_string(isolated.front());
    if (std::find(quiet.begin(), quiet.end(), isolated.front()) == quiet.end())
        return warn("isolation", "core " + first + " is isolated but still has its clock tick",
                    "add nohz_full=" + trimmed(m.isolated) +
                        " to GRUB_CMDLINE_LINUX in /etc/default/grub; sudo update-grub; restart");
    return ok("isolation",
              "isolated without a clock tick: " + trimmed(m.isolated) + "; run with --core " + first);
}

Finding servo_cores(const Machine& m) {
    const std::string shared = shared_cores_text(m.servos);
    if (!shared.empty())
        return warn("servo_cores", shared + ": the force loops delay each other", kSharedCoreFix);
    if (m.servos.empty()) return ok("servo_cores", "no controller runs pinned to a core");
    std::string all;
    for (const PinnedServo& s : m.servos)
        all += (all.empty() ? "" : ", ") + std::string("session ") + s.session + " on core " +
               std::to_string(s.core);
    return ok("servo_cores", "running controllers: " + all);
}

Finding rtprio(const Machine& m) {
    const std::string asked = "SCHED_FIFO " + std::to_string(kSupervisorPriority);
    if (m.fifo_error == 0) return ok("rtprio", asked + " is granted");
    const bool limit = m.rtprio_max < kSupervisorPriority && !has_capability(m.capabilities, kCapSysNice);
    const Lacking lacking = lacking_limit(m.person, "rtprio");
    return warn(
        "rtprio",
        limit
            ? asked + " is refused: RLIMIT_RTPRIO is " + std::to_string(m.rtprio_max) + "; " +
                  lacking_text(lacking, "realtime")
            : asked + " is refused (" + std::strerror(m.fifo_error) +
                  ") although the limits allow it: a container, or a control group without real-time runtime",
        limit ? lacking_fix(lacking)
              : "run outside the container, or give it --cap-add SYS_NICE --ulimit rtprio=" +
                    std::to_string(kSupervisorPriority));
}

Finding memlock(const Machine& m) {
    if (has_capability(m.capabilities, kCapIpcLock) || m.memlock_bytes_max == kNoLimit)
        return ok("memlock", "memory may be locked without limit");
    const std::string mib = std::to_string(m.memlock_bytes_max >> 20U) + " MiB";
    if (m.memlock_bytes_max >= kMemlockWanted) return ok("memlock", mib + " of memory may be locked");
    const Lacking lacking = lacking_limit(m.person, "memlock");
    return warn("memlock",
                "only " + mib + " of memory may be locked, so page faults can delay a cycle; " +
                    lacking_text(lacking, "realtime"),
                lacking_fix(lacking));
}

Finding frequency(const Machine& m) {
    if (m.governors.empty())
        return ok("frequency", "the processor clock is not scaled, or the system hides it");
    for (std::size_t i = 0; i < m.governors.size(); ++i) {
        if (trimmed(m.governors[i]) != "performance")
            return warn("frequency",
                        "core " + std::to_string(i) + " uses the frequency governor " +
                            trimmed(m.governors[i]) + ": cycles are slower after every pause",
                        "sudo apt-get install linux-cpupower; sudo cpupower frequency-set -g performance");
    }
    return ok("frequency", "all cores use the frequency governor performance");
}

Finding dma_latency(const Machine& m) {
    if (m.dma_latency_error == 0)
        return ok("dma_latency", "/dev/cpu_dma_latency can be opened: deep idle states are prevented");
    if (m.dma_latency_error == ENOENT)
        return warn("dma_latency", "/dev/cpu_dma_latency is missing: cores may wake up late",
                    "boot with the kernel option idle=poll; ignore this on a virtual machine");
    return warn("dma_latency",
                std::string("/dev/cpu_dma_latency cannot be opened: ") + std::strerror(m.dma_latency_error),
                lacking_group(m.person, "realtime") == Lacking::login ? kLoginFix : kRightsFix);
}

Finding throttling(const Machine& m) {
    const std::string text = trimmed(m.rt_runtime_us);
    if (text == "-1") return ok("throttling", "real-time threads are not throttled");
    if (text.empty()) return ok("throttling", "the kernel does not report real-time throttling");
    return {
        "throttling", FindingLevel::ok,
        "a real-time thread that never sleeps is stopped after " + text +
            " us of every second; the servo thread sleeps in every cycle, except with --free-run under FIFO",
        ""};
}

Finding memory(const Machine& m) {
    const auto swaps = parse_swaps(m.swaps);
    if (!swaps.empty())
        return warn("swap",
                    "swap is on (" + swaps.front() +
                        "): other programs may stall while the servo thread stays locked",
                    "sudo swapoff -a, and remove it from /etc/fstab");
    return ok("swap", "no swap");
}

Finding huge_pages(const Machine& m) {
    if (chosen_word(m.huge_pages) == "always")
        return warn("huge_pages",
                    "transparent huge pages are always on: the kernel may move memory while the servo runs",
                    "echo madvise | sudo tee /sys/kernel/mm/transparent_hugepage/enabled");
    return ok("huge_pages", "transparent huge pages: " +
                                (m.huge_pages.empty() ? "not available" : chosen_word(m.huge_pages)));
}

Finding clock(const Machine& m) {
    const std::string source = trimmed(m.clocksource);
    if (source == "tsc" || source == "arch_sys_counter" || source == "kvm-clock" || source.empty())
        return ok("clock",
                  "clock source " + (source.empty() ? "unknown" : source) + ": read without a system call");
    return warn("clock", "clock source " + source + ": every reading of the clock is a system call",
                "start with the kernel option clocksource=tsc");
}

Finding hypervisor(const Machine& m) {
    const auto flags = m.cpuinfo.find("\nflags");
    const auto end = m.cpuinfo.find('\n', flags == std::string::npos ? 0 : flags + 1);
    const bool guest = flags != std::string::npos &&
                       m.cpuinfo.substr(flags, end - flags).find(" hypervisor") != std::string::npos;
    if (!guest) return ok("machine", "not a virtual machine");
    return warn(
        "machine", "a virtual machine: the host may withdraw the processor at any time",
        "use a physical machine for a haptic device; the emulated device runs on a virtual machine too");
}

}  // namespace

Machine read_machine(const std::filesystem::path& root) {
    Machine m;
    utsname name{};
    if (uname(&name) == 0) m.kernel_version = std::string(name.release) + " " + name.version;
    const auto cpu = root / "sys/devices/system/cpu";
    m.realtime = read_small(root / "sys/kernel/realtime");
    m.isolated = read_small(cpu / "isolated");
    m.nohz_full = read_small(cpu / "nohz_full");
    m.cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    for (int i = 0; i < m.cores; ++i) {
        auto governor = read_small(cpu / ("cpu" + std::to_string(i)) / "cpufreq/scaling_governor");
        if (!governor.empty()) m.governors.push_back(std::move(governor));
    }
    m.rt_runtime_us = read_small(root / "proc/sys/kernel/sched_rt_runtime_us");
    m.swaps = read_small(root / "proc/swaps");
    m.huge_pages = read_small(root / "sys/kernel/mm/transparent_hugepage/enabled");
    m.clocksource = read_small(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
    m.cpuinfo = read_small(root / "proc/cpuinfo");
    m.capabilities = read_small(root / "proc/self/status");
    m.person = read_person(root);
    m.servos = pinned_servos(root / "proc");
    rlimit limit{};
    if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) m.rtprio_max = limit.rlim_cur;
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0)
        m.memlock_bytes_max = limit.rlim_cur == RLIM_INFINITY ? kNoLimit : limit.rlim_cur;
    m.fifo_error = error_of_fifo();
    m.dma_latency_error = error_of_dma_latency(root / "dev/cpu_dma_latency");
    return m;
}

std::vector<Finding> judge(const Machine& m) {
    return {kernel(m),     cores(m),     isolation(m),   servo_cores(m), rtprio(m),
            memlock(m),    frequency(m), dma_latency(m), throttling(m),  memory(m),
            huge_pages(m), clock(m),     hypervisor(m)};
}

std::vector<int> parse_core_list(const std::string& text) {
    std::vector<int> cores;
    std::istringstream in(trimmed(text));
    for (std::string part; std::getline(in, part, ',');) {
        int first = 0, last = 0;
        const char* const end = part.data() + part.size();
        auto [at, error] = std::from_chars(part.data(), end, first);
        if (error != std::errc{} || first < 0) return {};
        last = first;
        if (at != end) {
            if (*at != '-') return {};
            const auto second = std::from_chars(at + 1, end, last);
            if (second.ec != std::errc{} || second.ptr != end) return {};
        }
        if (last < first || last > 65535) return {};
        for (int c = first; c <= last; ++c) cores.push_back(c);
    }
    return cores;
}

bool has_capability(const std::string& status, int bit) {
    const auto at = status.find("CapEff:\t");
    if (at == std::string::npos) return false;
    const char* const begin = status.data() + at + 8;
    std::uint64_t bits = 0;
    const auto [end, error] = std::from_chars(begin, status.data() + status.size(), bits, 16);
    return error == std::errc{} && ((bits >> static_cast<unsigned>(bit)) & 1U) != 0;
}

std::string chosen_word(const std::string& text) {
    const auto open = text.find('['), close = text.find(']');
    return open == std::string::npos || close == std::string::npos || close < open
               ? ""
               : text.substr(open + 1, close - open - 1);
}

std::vector<std::string> parse_swaps(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream in(text);
    std::string line;
    std::getline(in, line);  // column titles
    while (std::getline(in, line))
        if (const auto end = line.find_first_of(" \t"); end != 0 && !line.empty())
            names.push_back(line.substr(0, end));
    return names;
}

}  // namespace tact::launch
