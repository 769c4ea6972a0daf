#include "tests/reproduce/shared_core.hpp"

#include <fcntl.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/x_server.hpp"
#include "ipc/base/error.hpp"
#include "ipc/shm/region.hpp"
#include "tests/reproduce/external_load.hpp"
#include "tests/reproduce/text.hpp"
#include "tests/reproduce/tick_source.hpp"

namespace tact::launch {
namespace {

constexpr const char* kSession = "reproduce";
constexpr int kPriority = 50;  // of runs with FIFO scheduling
constexpr int kSampleMs = 5;
// On an emulated processor the force model alone takes half a minute to start.
constexpr std::chrono::seconds kStartMost(150);

int last_core() {
    cpu_set_t mine;
    if (sched_getaffinity(0, sizeof mine, &mine) != 0) return 0;
    for (int c = CPU_SETSIZE - 1; c > 0; --c)
        if (CPU_ISSET(static_cast<std::size_t>(c), &mine)) return c;
    return 0;
}

// Processor time of a process; 0 if it does not exist.
double used_s(pid_t pid) {
    clockid_t clock{};
    timespec t{};
    if (pid <= 0 || clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &t) != 0) return 0.0;
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Of full detail; 1 for a path that the scene does not have.
double drawn_part(const LevelsTopic& levels, const char* path) {
    const auto level = level_of(levels, path);
    return level && level->items_max > 0 ? static_cast<double>(level->drawn) / level->items_max : 1.0;
}

}  // namespace

struct SharedCore::Parts {
    explicit Parts(const SharedCoreSettings& s)
        : settings(s),
          core(s.core >= 0 ? s.core : last_core()),
          x(scratch.path(), 640, 480),
          tick_source(core) {
        // The watchdog of the device tolerates a loop that waits for the processor.
        const std::string device = "[device]\nhand = \"wander\"\nwatchdog_us = 1e6\n";
        // As in the paper only the display adapts. Free running: no limit on the time of a step.
        const std::string whole_force = "[governor]\nforce_level_min = 1\n";
        write_whole(scratch.path() / "fifo.toml", whole_force + device);
        write_whole(scratch.path() / "tact.toml", whole_force + "[servo]\nmodel_us_max = 100000\n" + device);
        log = FileDescriptor(
            open((scratch.path() / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
        environment = x.environment();
        // Without Mesa's file of compiled shaders: on a core that a loop has taken, its thread of lowest priority holds up
        // the first frame for seconds.
        environment.insert(
            environment.end(),
            {{"LIBGL_ALWAYS_SOFTWARE", "1"}, {"LP_NUM_THREADS", "1"}, {"MESA_SHADER_CACHE_DISABLE", "true"}});
        environment.emplace_back("TACT_RUNTIME_DIR", scratch.path().string());
        setenv("TACT_RUNTIME_DIR", scratch.path().c_str(), 1);
    }

    ChildSettings child(std::vector<std::string> arguments) {
        ChildSettings s;
        s.arguments = std::move(arguments);
        s.environment = environment;
        s.cores = {core};
        s.output_fd = log.get();
        return s;
    }

    std::vector<std::string> arguments_of(const Run& run) const {
        std::vector<std::string> w{scene.path.string(),
                                   "--session",
                                   kSession,
                                   "--config",
                                   (scratch.path() / (run.fifo ? "fifo.toml" : "tact.toml")).string(),
                                   "--core",
                                   "-2",
                                   "--arm",
                                   "--law",
                                   run.law};
        const auto add = [&w](std::initializer_list<std::string> more) { w.insert(w.end(), more); };
        if (run.fifo)
            add({"--rate", std::to_string(run.goal_hz), "--priority", std::to_string(kPriority)});
        else
            add({"--free-run", "--priority", "0"});
        add({"--display-goal", std::to_string(run.display_goal_hz)});
        if (run.goal_hz > 0.0) add({"--goal", std::to_string(run.goal_hz)});
        if (run.law == "fixed") add({"--level", "docking.force=1"});
        if (run.mesh_level >= 0.0) add({"--level", "gui.mesh=" + std::to_string(run.mesh_level)});
        return w;
    }

    bool wait_until_drawing(Observer& observer, Child& controller, Child& visual) {
        const Instant end = Monotonic::now() + kStartMost;
        while (Monotonic::now() < end) {
            if (signals.wait(kSampleMs) != 0) return false;
            require_running(controller, visual);
            observer.poll();
            if (!observer.seen()) continue;
            const auto h = newest(observer.region().health);
            if (h && h->gui_attached != 0 && h->gui_vertices > 0 && h->gui_fps > 0.0) return true;
        }
        throw StartupError(
            "starting the experiment",
            text("tact-gui drew no frame within %lld s: ", static_cast<long long>(kStartMost.count())) +
                observer.status_text(),
            "start tact-gui by hand to see the cause; output:\n" + read_small(scratch.path() / "log"));
    }

    void require_running(Child& controller, Child& visual) const {
        for (Child* const c : {&controller, &visual})
            if (c->poll())
                throw StartupError(
                    "running the experiment", c->name() + " " + c->poll()->text(),
                    "run it alone to see the cause; output:\n" + read_small(scratch.path() / "log"));
    }

    bool record(Run& run, Observer& observer, Child& controller, Child& visual) {
        given_up = 0.0;
        trace = {.next = observer.region().trace.pushed() + 1, .missed = 0};
        const double on_s = run.phase.load_on_s(), end_s = run.phase.end_s();
        std::optional<ExternalLoad> load;
        const Instant begin = Monotonic::now();
        double t_s = 0.0;
        while (t_s <= end_s) {
            if (signals.wait(kSampleMs) != 0) return false;
            require_running(controller, visual);
            observer.poll();
            if (!load && run.phase.loaded_s > 0.0 && t_s >= on_s) load.emplace(core);
            take_sample(run, observer, begin,
                        {controller.pid(), visual.pid(), load ? load->pid() : -1, tick_source.pid()});
            t_s = to_s(Monotonic::now() - begin);
        }
        if (load) {
            load->stop();
            run.load_share = load->share();
        }
        return true;
    }

    void take_sample(Run& run, const Observer& observer, Instant begin,
                     const std::array<pid_t, kParties>& party) {
        TraceTopic update{};  // about five per sample; the ring holds several seconds
        while (observer.region().trace.next(trace, update))
            given_up += 1.0 - std::min(1.0, update.items / static_cast<double>(scene.points_summed));
        const auto b = newest(observer.region().bodies);  // published in every cycle
        RateSample s{.t_s = to_s(Monotonic::now() - begin)};
        for (std::size_t i = 0; i < kParties; ++i) s.used_s[i] = used_s(party[i]);
        const auto h = newest(observer.region().health);
        const auto l = newest(observer.region().levels);
        if (!b || !h || !l) return;
        s.cycle = b->cycle;
        s.vertices = h->gui_vertices;
        s.fps = h->gui_fps;
        s.load = party[2] > 0;
        if (const auto mesh = level_of(*l, kMeshPath)) s.level_mesh = static_cast<double>(mesh->level);
        if (const auto force = level_of(*l, kDockingPath)) s.level_force = static_cast<double>(force->level);
        s.structures = drawn_part(*l, kMoleculesPath);
        s.pixels = drawn_part(*l, kResolutionPath);
        s.given_up = given_up;
        run.samples.push_back(s);
    }

    SharedCoreSettings settings;
    int core;
    Signals signals;
    ScratchFolder scratch;
    XServer x;
    TickSource tick_source;
    std::vector<std::pair<std::string, std::string>> environment;
    FileDescriptor log;
    RingCursor trace;
    double given_up = 0.0;  // see RateSample
    ExperimentScene scene;
};

SharedCore::SharedCore(const SharedCoreSettings& settings) : parts_(std::make_unique<Parts>(settings)) {}
SharedCore::~SharedCore() = default;
int SharedCore::core() const { return parts_->core; }
bool SharedCore::finely_shared() const { return parts_->tick_source.running(); }
const std::filesystem::path& SharedCore::folder() const { return parts_->scratch.path(); }
void SharedCore::scene(const ExperimentScene& scene) { parts_->scene = scene; }

bool SharedCore::execute(Run& run) {
    std::printf("%s ...\n", run.name.c_str());
    std::fflush(stdout);
    Parts& p = *parts_;
    Child controller("tact-rt", find_program("tact-rt"), p.child(p.arguments_of(run)));
    Child visual("tact-gui", find_program("tact-gui"),
                 p.child({p.scene.path.string(), "--session", kSession, "--size", "320x240", "--fps-max",
                          std::to_string(p.settings.fps_max)}));
    Observer observer(kSession);
    const bool completed =
        p.wait_until_drawing(observer, controller, visual) && p.record(run, observer, controller, visual);
    visual.stop();
    visual.wait(std::chrono::seconds(5));
    controller.stop();
    controller.wait(std::chrono::seconds(5));
    run.summarize_with(0.0);
    return completed;
}

void Run::summarize_with(double fast_s) {
    const double loaded_from = phase.load_on_s() + phase.resettle_s;
    free = summarize(samples, phase.settle_s, phase.load_on_s(), goal_hz, fast_s);
    loaded = summarize(samples, loaded_from, loaded_from + phase.loaded_s, goal_hz, fast_s);
    const std::vector<RateRow> rows = rate_rows(samples, phase.settle_s, fast_s);
    worst_start = worst_window(rows, RunPart::start);
    worst_free = worst_window(rows, RunPart::no_load);
    worst_loaded = worst_window(rows, RunPart::load);
    if (goal_hz <= 0.0) return;
    settled_free_s = settling_s(samples, 0.0, phase.load_on_s(), goal_hz);
    if (phase.loaded_s > 0.0)
        settled_loaded_s = settling_s(samples, phase.load_on_s(), phase.end_s(), goal_hz);
}

}  // namespace tact::launch
