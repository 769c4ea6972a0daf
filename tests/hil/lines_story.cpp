// tact-rt as shipped, with safety inputs on a CP2112 adapter through the kernel's own driver and libgpiod: every stop leads
// to zero force, latched with its cause, cleared only by a person; a stopped servo loses its enable line.
//
// usage: hil_lines_story [FIFO_PRIORITY CORE [counted]]. As root, on a kernel with uhid and hid-cp2112. "counted": the
//        machine's clock counts instructions, so that no host delays it; then the supervisor's limit is 5 ms, as
//        deployed, and the enable line of a starved servo must be low within 10 ms.
// Exit  0 passed, 1 failed (the last line gives the reason), 77 the kernel has no uhid
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "ipc/topics/text.hpp"
#include "tests/emu/cp2112.hpp"
#include "tests/scenario/rig.hpp"

namespace tact::scenario {
namespace {

// The wiring in this check.
enum Pin : unsigned { kStopA, kStopB, kPedal, kAmplifier, kEnable, kWatchdog, kLamp };

// Large limits: a busy host pauses its processor from time to time.
constexpr const char* kPatient = R"([servo]
period_us = 1000.0
model_us_max = 900.0
[safety]
sample_age_us_max = 1e6
supervisor_us_max = 5e6
)";
constexpr const char* kCounted = R"([servo]
period_us = 2000.0
spin_us = 0.0
model_us_max = 900.0
[safety]
sample_age_us_max = 1e6
)";
constexpr double kEnableLowMs = 10.0;  // after the busy thread started
constexpr const char* kLines = R"([lines]
sample_us = 2000.0
driver = "gpio"
chip = "cp2112_gpio"
emergency_stop_a = "0"
emergency_stop_b = "1"
dead_man = "2"
amplifier = "3"
enable = "4"
watchdog = "5"
lamp = "6"
discrepancy_ms = 500.0
follow_ms = 5000.0
age_us_max = 5e6
)";

void claim(bool good, const std::string& what) {
    if (good) return;
    std::printf("FAILED: %s\n", what.c_str());
    std::exit(1);
}

class Story {
public:
    Story(std::string priority, std::string core, bool counted)
        : config_(std::string(counted ? kCounted : kPatient) + kLines),
          core_(std::stoi(core)),
          counted_(counted) {
        more_ = {"--priority", std::move(priority), "--core", std::move(core)};
        close_contacts();
        adapter_.follow(kAmplifier, kEnable);
        adapter_.plug();
    }

    void start() {
        controller_.emplace(rig_, more_, config_);
        claim(watch_.attach(), "a controller starts; its log: " + controller_->said());
        to_force("at the start");
    }

    // One kind of stop.
    struct Stop {
        const char* name;
        std::vector<Pin> opens;
        RunReason reason;
        bool both_after;  // closed contacts are accepted only after both were open
    };
    void stops(const Stop& stop) {
        const Instant opened = Monotonic::now();
        for (const Pin pin : stop.opens) adapter_.set(pin, false);
        faults(stop.name, stop.reason, opened);
        claim(until([&] { return !adapter_.level(kEnable); }), name(stop.name) + "the enable line goes low");
        claim(until([&] { return !adapter_.level(kAmplifier); }), name(stop.name) + "the amplifier is off");
        // Once the contacts have differed for long enough, a single open contact is a wiring fault.
        if (stop.both_after) {
            claim(until([&] {
                      return watch_.health().lines_reason == static_cast<int>(RunReason::stop_channels);
                  }),
                  name(stop.name) + "the channels are reported to disagree");
            close_contacts();
            claim(watch_.cycles_pass(200), "the loop continues");
            claim(command(visual_, watch_, CommandKind::reset_fault) == CommandResult::refused_state,
                  name(stop.name) + "a single contact that closes again is not accepted");
            adapter_.set(kStopA, false);
            adapter_.set(kStopB, false);
            claim(until([&] {
                      return watch_.health().lines_reason == static_cast<int>(RunReason::emergency_stop);
                  }),
                  name(stop.name) + "both contacts are reported open");
        }
        close_contacts();
        claim(until([&] { return watch_.health().lines == static_cast<int>(LinesShown::waiting); }),
              name(stop.name) + "closed contacts wait for a person");
        stays_off(stop.name);
        recovers(stop.name);
    }

    void unplugged() {
        const Instant pulled = Monotonic::now();
        adapter_.unplug();
        faults("adapter unplugged", RunReason::lines_lost, pulled);
        claim(command(visual_, watch_, CommandKind::reset_fault) == CommandResult::refused_state,
              "a reset without the adapter is refused");
        adapter_.plug();
        claim(until([&] { return watch_.health().lines == static_cast<int>(LinesShown::waiting); }),
              "the adapter is found again after the replug");
        claim(!adapter_.level(kEnable), "the enable line is low after the replug");
        stays_off("adapter unplugged");
        recovers("adapter unplugged");
    }

    // All other threads run normally; only the servo gets no processor time.
    void hogged() {
        void* shared =
            mmap(nullptr, sizeof(std::int64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        claim(shared != MAP_FAILED, "shared memory is available");
        auto* begun_ns = new (shared) std::atomic<std::int64_t>(0);
        const pid_t hog = fork();
        if (hog == 0) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<std::size_t>(core_), &set);
            sched_param param{};
            param.sched_priority = std::stoi(more_[1]);
            if (sched_setaffinity(0, sizeof set, &set) != 0 || sched_setscheduler(0, SCHED_FIFO, &param) != 0)
                _exit(1);
            begun_ns->store(to_ns(Monotonic::now()));
            // QEMU with a counted clock switches to the other processor at a PAUSE; without it this loop would stop the whole
            // machine, which a busy thread on real hardware does not.
            for (;;) {
                for (int i = 0; i < 5000; ++i) asm volatile("");
                __builtin_ia32_pause();
            }
        }
        const bool low = until([&] { return !adapter_.level(kEnable); });
        const double ms = static_cast<double>(to_ns(Monotonic::now()) - begun_ns->load()) * 1e-6;
        const std::uint64_t edges = adapter_.edges(kWatchdog);
        const std::uint64_t cycle = watch_.tool().cycle;
        int status = 0;
        const bool ran = waitpid(hog, &status, WNOHANG) == 0;
        kill(hog, SIGKILL);
        if (ran) waitpid(hog, &status, 0);
        claim(ran, "the busy thread runs on the servo's core at its priority");
        claim(low, "a starved servo loses its enable line");
        std::printf(
            "busy thread at the servo's priority: enable low after %.1f ms (supervisor limit %s ms), "
            "%llu edges of the watchdog line, cycle %llu\n",
            ms, counted_ ? "5" : "5000", static_cast<unsigned long long>(edges),
            static_cast<unsigned long long>(cycle));
        claim(until([&] { return watch_.state() == RunState::fault; }), "the dropped enable line is a fault");
        std::printf("  reason: %s\n", run_reason_text(static_cast<RunReason>(watch_.health().reason)));
        claim(watch_.health().reason == static_cast<int>(RunReason::supervisor),
              "the supervisor is the cause");
        claim(!counted_ || ms <= kEnableLowMs, "a starved servo's enable line is low within 10 ms");
        stays_off("busy thread");
        recovers("busy thread");
    }

    void killed() {
        ::kill(controller_->child().pid(), SIGKILL);
        claim(controller_->child().wait(std::chrono::minutes(1)).has_value(), "a killed controller ends");
        const std::uint64_t edges = adapter_.edges(kWatchdog);
        ::usleep(200'000);
        claim(adapter_.edges(kWatchdog) == edges,
              "the watchdog line stops toggling when the controller is dead");
        controller_.reset();
    }

    void refusals() {
        const auto says = [&](const std::string& from, const std::string& to, const std::string& wanted) {
            std::string text = config_;
            text.replace(text.find(from), from.size(), to);
            const auto config = rig_.file("refused.toml", text);
            const auto said = run_to_end(rig_, rt_program(),
                                         {rig_.scene().string(), "--check", "--config", config.string()});
            claim(said && said->ending.number != 0 && said->text.find(wanted) != std::string::npos,
                  "tact-rt --check reports " + wanted + "; its output: " + (said ? said->text : ""));
        };
        says("chip = \"cp2112_gpio\"", "chip = \"other\"", "the chips present are gpiochip");
        says("lamp = \"6\"", "lamp = \"11\"", "requesting line \"11\"");
        says("lamp = \"6\"", "lamp = \"5\"", "assigned to two keys");
        says("lamp = \"6\"", "lamp = \"STATE\"", "the chip has no such line");
    }

private:
    static std::string name(const std::string& stop) { return stop + ": "; }
    void close_contacts() {
        for (const Pin pin : {kStopA, kStopB, kPedal}) adapter_.set(pin, true);
    }
    void to_force(const std::string& when) {
        claim(bring_to_force(visual_, watch_),
              when + ": a force is on; the controller's log: " + controller_->said());
        claim(until([&] { return adapter_.level(kEnable) && adapter_.level(kAmplifier); }),
              when + ": enable line and amplifier are on; the controller's log: " + controller_->said());
        claim(until([&] { return adapter_.level(kLamp); }), when + ": the lamp is lit");
        const std::uint64_t edges = adapter_.edges(kWatchdog);
        claim(until([&] { return adapter_.edges(kWatchdog) > edges + 10; }),
              when + ": the watchdog line toggles");
    }
    void faults(const std::string& what, RunReason reason, Instant since) {
        claim(until([&] {
                  visual_.frame();
                  return watch_.state() == RunState::fault;
              }),
              name(what) + "the stop is a fault");
        const HealthTopic h = watch_.health();
        claim(h.reason == static_cast<int>(reason), name(what) + "its cause is as expected, not: " +
                                                        run_reason_text(static_cast<RunReason>(h.reason)));
        claim(watch_.force_n() == 0.0, name(what) + "the force is zero");
        say_how_fast(what, since);
    }
    // From the trace: the first cycle in fault, and whether the force was zero in that very cycle.
    void say_how_fast(const std::string& what, Instant since) {
        claim(watch_.cycles_pass(2), "the loop continues");
        RingCursor at = watch_.region().trace.tail();
        at.next = at.next > 8000 ? at.next - 8000 : 1;
        TraceTopic t{};
        std::uint64_t first = 0, before = 0;
        double age_ms = 0.0;
        while (watch_.region().trace.next(at, t)) {
            if (t.taken_at_ns < to_ns(since)) {
                before = t.cycle;
                continue;
            }
            if ((t.status & 0xFFU) != static_cast<unsigned>(RunState::fault)) continue;
            const bool zero =
                t.force_world_n[0] == 0.0F && t.force_world_n[1] == 0.0F && t.force_world_n[2] == 0.0F;
            claim(zero, name(what) + "zero force in each cycle with a fault");
            if (first == 0) {
                first = t.cycle;
                age_ms = static_cast<double>(t.taken_at_ns - to_ns(since)) * 1e-6;
            }
        }
        claim(first != 0, name(what) + "the trace contains the fault");
        std::printf(
            "%-20s zero force in the cycle that detected it, %llu cycles and %.1f ms after the event\n",
            what.c_str(), static_cast<unsigned long long>(first - before), age_ms);
    }
    // With closed contacts alone everything stays off, even after an arm command.
    void stays_off(const std::string& what) {
        claim(watch_.cycles_pass(100), "the loop continues");
        claim(command(visual_, watch_, CommandKind::arm) == CommandResult::refused_state,
              name(what) + "arming in state fault is refused");
        claim(watch_.state() == RunState::fault && watch_.force_n() == 0.0 && !adapter_.level(kEnable),
              name(what) + "without a person everything stays off");
    }
    void recovers(const std::string& what) {
        claim(command(visual_, watch_, CommandKind::reset_fault) == CommandResult::done,
              name(what) + "a person resets");
        claim(watch_.state() == RunState::ready && !adapter_.level(kEnable),
              name(what) + "a reset leads to ready");
        to_force(what + ", armed again");
    }

    Rig rig_;
    emu::EmulatedLines adapter_;
    Watch watch_{rig_};
    Visual visual_{rig_};
    std::vector<std::string> more_;
    std::string config_;
    int core_;
    bool counted_;
    std::optional<Controller> controller_;
};

int tell(const std::string& priority, const std::string& core, bool counted) {
    Story story(priority, core, counted);
    // The chip appears a moment after the adapter.
    claim(until([] { return access("/dev/gpiochip0", F_OK) == 0 || access("/dev/gpiochip1", F_OK) == 0; }),
          "a gpiochip appears");
    story.refusals();
    story.start();
    const Story::Stop stops[] = {
        {"emergency stop", {kStopA, kStopB}, RunReason::emergency_stop, false},
        {"wire of channel a", {kStopA}, RunReason::emergency_stop, true},
        {"wire of channel b", {kStopB}, RunReason::emergency_stop, true},
        {"dead-man", {kPedal}, RunReason::dead_man, false},
    };
    for (const Story::Stop& stop : stops) story.stops(stop);
    story.unplugged();
    story.unplugged();
    if (priority != "0") story.hogged();
    story.killed();
    std::printf(
        "emergency stop, broken wires, dead-man, unplugged twice%s: zero force in the cycle that detected "
        "it, "
        "latched, "
        "re-armed only by a person\n",
        priority == "0" ? "" : ", servo starved");
    return 0;
}

}  // namespace
}  // namespace tact::scenario

int main(int argc, char** argv) {
    if (access("/dev/uhid", R_OK | W_OK) != 0) {
        std::puts("no /dev/uhid here");
        return 77;
    }
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    try {
        return tact::scenario::tell(argc >= 3 ? argv[1] : "0", argc >= 3 ? argv[2] : "-2", argc == 4);
    } catch (const std::exception& e) {
        std::printf("%s\n", e.what());
        return 1;
    }
}
