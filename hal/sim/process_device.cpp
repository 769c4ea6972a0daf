#include "hal/sim/process_device.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/pacer.hpp"
#include "ipc/base/servo_clock.hpp"
#include "ipc/shm/latest.hpp"

namespace tact {

namespace {

constexpr Duration kStep = std::chrono::milliseconds(1);
constexpr Duration kLostAfter = std::chrono::milliseconds(100);
constexpr Duration kStartMax = std::chrono::seconds(30);    // also on a busy machine
constexpr Duration kOrphanLives = std::chrono::seconds(1);  // long enough to observe its watchdog

// Trivially copyable sample and command, for Latest.
struct SampleWords {
    std::int64_t taken_at_ns;
    std::uint64_t sequence;
    double pos_m[3], quat_xyzw[4], linear_m_s[3], angular_rad_s[3];
    std::uint32_t buttons;
    std::uint8_t hand_present, state, reserved[2];
};
struct CommandWords {
    double force_n[3], torque_n_m[3];
    std::uint64_t heartbeat, enable;
};

const char* state_name(DeviceState s) noexcept {
    switch (s) {
        case DeviceState::closed:
            return "closed";
        case DeviceState::ready:
            return "ready";
        case DeviceState::powered:
            return "powered";
        case DeviceState::watchdog_tripped:
            return "watchdog_tripped";
        case DeviceState::fault:
            return "fault";
    }
    return "unknown";
}

SampleWords to_words(const DeviceSample& s) noexcept {
    SampleWords w{};
    w.taken_at_ns = to_ns(s.taken_at);
    w.sequence = s.sequence;
    for (int i = 0; i < 3; ++i) {
        w.pos_m[i] = s.T_dev_tool.p_m[i];
        w.linear_m_s[i] = s.twist_dev.linear_m_s[i];
        w.angular_rad_s[i] = s.twist_dev.angular_rad_s[i];
    }
    for (int i = 0; i < 4; ++i) w.quat_xyzw[i] = s.T_dev_tool.q.coeffs()[i];
    w.buttons = s.buttons;
    w.hand_present = s.hand_present ? 1 : 0;
    w.state = static_cast<std::uint8_t>(s.state);
    return w;
}

DeviceSample from_words(const SampleWords& w) noexcept {
    DeviceSample s;
    s.taken_at = instant_from_ns(w.taken_at_ns);
    s.sequence = w.sequence;
    s.T_dev_tool.p_m = Vec3(w.pos_m[0], w.pos_m[1], w.pos_m[2]);
    s.T_dev_tool.q = Quat(w.quat_xyzw[3], w.quat_xyzw[0], w.quat_xyzw[1], w.quat_xyzw[2]);
    s.twist_dev.linear_m_s = Vec3(w.linear_m_s[0], w.linear_m_s[1], w.linear_m_s[2]);
    s.twist_dev.angular_rad_s = Vec3(w.angular_rad_s[0], w.angular_rad_s[1], w.angular_rad_s[2]);
    s.buttons = w.buttons;
    s.hand_present = w.hand_present != 0;
    s.state = static_cast<DeviceState>(
        std::min<std::uint8_t>(w.state, static_cast<std::uint8_t>(DeviceState::fault)));
    return s;
}

}  // namespace

struct ProcessDevice::Shared {
    Latest<SampleWords> sample;
    Latest<CommandWords> command;
    std::atomic<std::uint32_t> leave;
};

ProcessDevice::ProcessDevice(const SimSettings& settings, std::string log_path)
    : settings_(settings), log_path_(std::move(log_path)) {}

ProcessDevice::~ProcessDevice() {
    if (shared_ == nullptr) return;
    relax();
    shared_->leave.store(1, std::memory_order_relaxed);
    while (child_ > 0 && waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
    munmap(shared_, sizeof(Shared));
}

DeviceInfo ProcessDevice::open() {
    const DeviceInfo info = SimDevice(settings_).open();  // the same values; also checks the script's name
    if (shared_ != nullptr) return info;
    void* const memory =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        throw StartupError("allocating memory shared with the emulated device", std::strerror(errno),
                           "free some memory");
    shared_ = new (memory) Shared{};
    const pid_t parent = getpid();
    child_ = fork();
    if (child_ < 0) {
        const std::string why = std::strerror(errno);
        munmap(memory, sizeof(Shared));
        shared_ = nullptr;
        throw StartupError("starting the emulated device's process", why,
                           "raise the limit of processes (ulimit -u)");
    }
    if (child_ == 0) live(settings_, parent);
    wait_for_life();
    return info;
}

// The first sample proves that the child runs.
void ProcessDevice::wait_for_life() {
    SampleWords first{};
    const Instant end = Monotonic::now() + kStartMax;
    while (!shared_->sample.read(first)) {
        int status = 0;
        if (waitpid(child_, &status, WNOHANG) == child_) {
            child_ = -1;
            throw StartupError(
                "starting the emulated device's process",
                WIFSIGNALED(status)
                    ? std::string("the process died at once: ") + sigdescr_np(WTERMSIG(status))
                    : "the process ended at once with code " + std::to_string(WEXITSTATUS(status)),
                "check the kernel's log (dmesg); memory may have run out");
        }
        if (Monotonic::now() >= end) {
            kill(child_, SIGKILL);  // it may be stopped; waitpid() would then block
            throw StartupError("starting the emulated device's process",
                               "the process gave no sample within 30 s", "reduce the load of the processor");
        }
        usleep(1000);
    }
}

// In the child. It keeps no descriptor of its parent, above all not the session's lock file, which would
// otherwise stay locked after the parent's death.
void ProcessDevice::live(const SimSettings& settings, pid_t parent) noexcept {
    const int log =
        log_path_.empty() ? -1 : ::open(log_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    const int quiet = ::open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3; ++fd) dup2(quiet, fd);
    const int kept = log >= 0 ? dup2(log, 3) : 2;
    close_range(static_cast<unsigned>(kept) + 1, ~0U, 0);
    signal(SIGINT, SIG_IGN);  // Ctrl-C in the terminal is for the controller, which then relaxes this device
    signal(SIGTERM, SIG_DFL);
    sched_param param{};
    param.sched_priority = 85;  // above the servo, like a bus pump; without the right: ordinary
    sched_setscheduler(0, SCHED_FIFO, &param);

    SimDevice device(settings);
    static_cast<void>(device.open());
    ServoClock clock(Duration{0});
    Pacer pacer(kStep, clock.now());
    std::uint64_t heartbeat = 0;
    Instant heard_at = clock.now();
    Instant orphan_since{};
    DeviceState said = DeviceState::closed;
    while (shared_->leave.load(std::memory_order_relaxed) == 0) {
        clock.wait_until(pacer.planned());
        const Instant now = clock.now();
        const Duration silence = now - heard_at;  // includes hangs of this process, before a late command
        CommandWords c{};
        if (shared_->command.read(c) && c.heartbeat != heartbeat) {
            heartbeat = c.heartbeat;
            heard_at = now;
            DeviceCommand command;
            command.wrench_dev = {Vec3(c.force_n[0], c.force_n[1], c.force_n[2]),
                                  Vec3(c.torque_n_m[0], c.torque_n_m[1], c.torque_n_m[2])};
            command.enable = c.enable != 0;
            command.heartbeat = c.heartbeat;
            static_cast<void>(device.write(command, now));
        }
        DeviceSample sample;
        static_cast<void>(device.read(sample, now));
        shared_->sample.publish(to_words(sample));
        if (device.state() != said && kept == 3) {
            said = device.state();
            char line[128];
            const int n = std::snprintf(line, sizeof line, "%lld %s %.4f N silence %.2f ms\n",
                                        static_cast<long long>(to_ns(now)), state_name(said),
                                        device.shown_dev().force_n.norm(), to_us(silence) * 1e-3);
            static_cast<void>(!::write(kept, line, static_cast<std::size_t>(n)));
        }
        if (getppid() != parent) {
            if (orphan_since == Instant{}) orphan_since = now;
            if (now - orphan_since > kOrphanLives) break;
        }
        static_cast<void>(pacer.ended(clock.now()));
    }
    _exit(0);
}

IoStatus ProcessDevice::read(DeviceSample& newest, Instant now) noexcept {
    SampleWords w{};
    if (shared_ == nullptr || !shared_->sample.read(w)) return IoStatus::lost;
    newest = from_words(w);
    if (now - newest.taken_at > kLostAfter) {
        newest.notice = DeviceNotice::gone;
        return IoStatus::lost;
    }
    newest.taken_at =
        std::min(newest.taken_at, now);  // it may be newer than the loop's time stamp of this cycle
    const bool fresh = w.sequence != sequence_;
    sequence_ = w.sequence;
    if (newest.state == DeviceState::fault) return IoStatus::fault;
    return fresh ? IoStatus::ok : IoStatus::stale;
}

IoStatus ProcessDevice::write(const DeviceCommand& command, Instant /*now*/) noexcept {
    if (shared_ == nullptr) return IoStatus::lost;
    CommandWords w{};
    for (int i = 0; i < 3; ++i) {
        w.force_n[i] = command.wrench_dev.force_n[i];
        w.torque_n_m[i] = command.wrench_dev.torque_n_m[i];
    }
    w.enable = command.enable ? 1 : 0;
    w.heartbeat = heartbeat_ = command.heartbeat;
    shared_->command.publish(w);
    return IoStatus::ok;
}

void ProcessDevice::relax() noexcept {
    if (shared_ == nullptr) return;
    CommandWords w{};
    // A heartbeat outside the loop's range, so that the child accepts this command and the next one.
    w.heartbeat = ++heartbeat_ | 1ULL << 63U;
    shared_->command.publish(w);
}

}  // namespace tact
