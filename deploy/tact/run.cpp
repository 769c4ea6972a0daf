#include "deploy/tact/run.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/look_back.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/run_children.hpp"
#include "deploy/tact/run_record.hpp"
#include "deploy/tact/run_report.hpp"
#include "deploy/tact/scene_switch.hpp"
#include "deploy/tact/servo_core.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/systems.hpp"
#include "deploy/tact/x_server.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact::launch {
namespace {

constexpr auto kAttachLimit = std::chrono::seconds(60);     // loading a large map takes seconds
constexpr auto kWindowPatience = std::chrono::seconds(60);  // start of a window under software drawing
constexpr auto kSampleEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(1);
constexpr auto kLeaveCoreEvery = std::chrono::seconds(1);
constexpr int kHeaderEvery = 20;
constexpr const char* kOwnFlightsKept = "8";  // some 14 MB each

class OneRun {
public:
    // The first scene of a run is armed when the run is up; for a scene opened from the window, a person arms it.
    OneRun(const Asked& asked, RunOptions options, SceneSwitch* scene_switch, bool first)
        : options_(std::move(options)),
          scene_switch_(scene_switch),
          first_(first),
          asked_(asked),
          file_(SceneFile::open(asked.scene)),
          system_(system_of(file_).open_run(file_)),
          observer_(options_.session) {
        facts_.scene = std::filesystem::absolute(asked.scene);
        facts_.session = options_.session;
        if (!options_.save.empty()) system_->check_save(options_.save);  // fails before the run, not after it
    }

    int go() {
        refuse_second();
        start();
        while (!over()) {
            const int asked = signals_.wait(20);
            look();
            if (asked != 0 && !ending_) end(true, std::string("requested by signal: ") + sigdescr_np(asked));
        }
        return finish();
    }

    // What the window requested, if the run ended for it.
    [[nodiscard]] const std::optional<Asked>& next() const { return next_; }
    [[nodiscard]] bool came_up() const { return seen_at_.has_value(); }

private:
    void refuse_second() {
        // A dead controller's socket accepts no connection; a living controller need not have answered yet.
        observer_.poll();
        if (observer_.reached())
            throw StartupError("starting a run in session " + options_.session,
                               "a controller already runs in this session",
                               "end that controller, or give this run another session with --session");
    }

    void start() {
        if (options_.gui) prepare_display();
        if (!first_) {  // they were meant for the scene before
            options_.keep.clear();
            options_.drop_controller_option("--resume");
            if (asked_.bodies)  // the session has them where they are to be
                for (const char* const option :
                     {"--poses", "--copies", "--start-offset-a", "--start-rotation-deg"})
                    options_.drop_controller_option(option);
        }
        const auto begin_with = [this](bool wanted, const char* option, const std::filesystem::path& file) {
            if (wanted && !options_.has_controller_option(option))
                options_.controller.insert(options_.controller.end(), {option, file.string()});
        };
        begin_with(!asked_.bone.empty(), "--resume", asked_.bone);
        begin_with(asked_.bodies, "--poses", asked_.session);
        if (!asked_.session.empty())
            options_.visual.insert(options_.visual.end(), {"--open-session", asked_.session.string()});
        // Before the controller, like a recording.
        auto words = system_->keeper_arguments(options_);
        if (words.empty() && !options_.keep.empty())
            throw StartupError("keeping drilled bone in " + options_.keep.string(), "this scene has no bone",
                               "remove --keep");
        if (!words.empty()) {
            ChildSettings keeper;
            keeper.arguments = std::move(words);
            keeper.grace = options_.grace;
            keeper_.emplace("tact-record", find_program("tact-record", options_.programs), keeper);
        }
        ChildSettings rt;
        rt.arguments = controller_arguments(facts_.scene, options_, first_);
        rt.grace = options_.grace;
        if (!options_.record.empty()) {  // started before the controller, to record its first cycle
            ChildSettings record;
            record.arguments = {options_.record.string(), "--session", options_.session, "--quiet"};
            record.grace = options_.grace;
            record_.emplace("tact-record", find_program("tact-record", options_.programs), record);
        }
        if (!options_.flight.empty()) {
            ChildSettings flight;
            flight.arguments = {"--flight", options_.flight.string(), "--session", options_.session};
            if (!options_.flight_typed)
                flight.arguments.insert(flight.arguments.end(), {"--keep", kOwnFlightsKept});
            flight.grace = options_.grace;
            flight_.emplace("tact-record", find_program("tact-record", options_.programs), flight);
        }
        rt_.emplace("tact-rt", find_program("tact-rt", options_.programs), rt);
        if (options_.gui) {
            ChildSettings gui;
            gui.arguments = window_arguments(facts_.scene, options_, scene_switch_, first_,
                                             system_->window_options([this] { return scratch().path(); }));
            gui.environment = display_;
            gui.grace = options_.grace;
            gui_.emplace("tact-gui", find_program("tact-gui", options_.programs), gui);
        }
        started_ = Monotonic::now();
    }

    const ScratchFolder& scratch() {
        if (!scratch_) scratch_.emplace();
        return *scratch_;
    }

    void prepare_display() {
        if (options_.headless) {
            x_.emplace(scratch().path(), options_.size);
            display_ = x_->environment();
            return;
        }
        const auto set = [](const char* name) {
            const char* const v = std::getenv(name);
            return v != nullptr && v[0] != '\0';
        };
        if (!set("DISPLAY") && !set("WAYLAND_DISPLAY"))
            throw StartupError(
                "opening a window", "neither DISPLAY nor WAYLAND_DISPLAY is set",
                "add --headless to draw without a screen, or --no-gui to run the controller alone");
    }

    // One poll of everything: link, samples, table, children.
    void look() {
        const Instant now = Monotonic::now();
        if (observer_.poll() == Observer::News::arrived) {
            if (!seen_at_) seen_at_ = now;
        }
        if (observer_.seen()) system_->watch(observer_.region());
        if (observer_.seen() && rt_ && !rt_->poll() && now >= core_due_) leave_core(now);
        if (observer_.seen() && rt_ && !rt_->poll() && now >= sample_due_) take(now);
        judge(now);
        if (scene_switch_ != nullptr && !ending_ && now >= asked_due_) {
            asked_due_ = now + kSampleEvery;
            look_back();
            if ((next_ = scene_switch_->poll(file_))) {
                end(true, next_->bone.empty() ? "another scene was requested: " + next_->scene.string()
                                              : "drilled bone was requested: " + next_->bone.string());
                rt_->stop();  // at once: the force ends before the window closes
            }
        }
    }

    void look_back() {
        if (!past_) past_.emplace(options_, scene_switch_->folder(), facts_.scene);
        try {
            if (const auto ago_s = take_asked_past(scene_switch_->folder())) {
                if (!flight_ || flight_->poll())
                    throw StartupError("looking back", "this run has no flight recorder",
                                       "start it again without --no-flight");
                past_->begin(*ago_s, flight_->pid());
            }
            past_->poll();
        } catch (const StartupError& e) {
            scene_switch_->refuse(e.what());
        }
    }

    void leave_core(Instant now) {
        const auto core = servo_core(rt_->pid());
        if (!core) return;  // not started yet, or the thread is not pinned
        core_due_ = now + kLeaveCoreEvery;
        keep_off_core(getpid(), *core);
        if (gui_ && !gui_->poll()) keep_off_core(gui_->pid(), *core);
        if (record_ && !record_->poll()) keep_off_core(record_->pid(), *core);
        if (flight_ && !flight_->poll()) keep_off_core(flight_->pid(), *core);
        if (keeper_ && !keeper_->poll()) keep_off_core(keeper_->pid(), *core);
        if (x_ && !x_->child().poll()) keep_off_core(x_->child().pid(), *core);
    }

    void take(Instant now) {
        sample_due_ = now + kSampleEvery;
        auto sample = take_sample(observer_.region(), system_.get(), to_s(now - *seen_at_));
        if (!sample) return;
        if (!options_.quiet && now >= line_due_) {
            line_due_ = now + kLineEvery;
            if (lines_++ % kHeaderEvery == 0) std::fputs(table_header(*sample).c_str(), stdout);
            std::fputs(table_row(*sample).c_str(), stdout);
            std::fflush(stdout);
        }
        if (sample->health.gui_attached != 0 && sample->health.gui_fps > 0.0)
            fps_.push_back(sample->health.gui_fps);
        if (!options_.out.empty()) samples_.push_back(*sample);
    }

    void judge(Instant now) {
        if (ending_) {
            if (gui_) gui_->poll();
            // The controller ends last, so that the last frame shows it at work.
            if (!gui_ || gui_->poll()) rt_->stop();
            rt_->poll();
            return;
        }
        if (rt_->poll()) {
            end(false, "tact-rt " + rt_->poll()->text());
        } else if (gui_ && gui_->poll()) {
            const Ending& e = *gui_->poll();
            if (e.clean())
                end(true, options_.seconds > 0.0 ? "the time is over" : "the window was closed");
            else
                end(false, "tact-gui " + e.text());
        } else if (x_ && x_->child().poll()) {
            end(false, "Xvfb " + x_->child().poll()->text());
        } else if (!seen_at_ && now > started_ + kAttachLimit) {
            end(false, "the controller did not start: " + observer_.status_text());
        } else if (options_.seconds > 0.0 && seen_at_) {
            const Duration length(std::llround(options_.seconds * 1e9));
            if (!gui_ && now >= *seen_at_ + length) end(true, "the time is over");
            if (gui_ && now >= *seen_at_ + length + kWindowPatience)
                end(false, "tact-gui did not end in time");
        }
    }

    void end(bool intended, std::string why) {
        ending_ = true;
        facts_.intended = intended;
        facts_.why_ended = std::move(why);
        if (gui_) gui_->stop();
        if (!gui_ || gui_->poll()) rt_->stop();
    }

    [[nodiscard]] bool over() { return ending_ && rt_->poll() && (!gui_ || gui_->poll()); }

    int finish() {
        if (past_) past_->stop();
        for (std::optional<Child>* const recorder :
             {&record_, &flight_, &keeper_}) {  // they end by themselves after the controller
            if (!*recorder) continue;
            if (!(*recorder)->wait(std::chrono::seconds(10))) (*recorder)->stop();
            const auto& ending = (*recorder)->wait(options_.grace + std::chrono::seconds(1));
            if (!ending) continue;
            // A flight recorder that nobody asked for, in a folder that cannot be written, is no failure of the run.
            if (recorder == &flight_ && !options_.flight_typed && !ending->clean())
                std::fprintf(stderr, "tact-record %s: this run kept no past to look back to\n",
                             ending->text().c_str());
            else
                note("tact-record", *ending);
        }
        if (x_) {
            x_->child().stop();
            x_->child().wait(std::chrono::seconds(10));
        }
        note("tact-rt", *rt_->poll());
        if (gui_) note("tact-gui", *gui_->poll());
        if (seen_at_) facts_.length_s = samples_length();
        if (!fps_.empty()) {
            const auto middle = fps_.begin() + static_cast<std::ptrdiff_t>(fps_.size() / 2);
            std::nth_element(fps_.begin(), middle, fps_.end());
            facts_.fps_median = *middle;
        }
        const RtRegion* const region = observer_.seen() ? &observer_.region() : nullptr;
        const nlohmann::json report = run_report(region, *system_, facts_);
        std::printf("the run ended: %s\n", facts_.why_ended.c_str());
        std::fputs(report_summary(report).c_str(), stdout);
        std::fflush(stdout);  // before output of the next scene's programs, also in a file
        if (!options_.json.empty()) {
            write_whole(options_.json, report_text(report));
            std::printf("wrote %s\n", options_.json.c_str());
        }
        if (!options_.out.empty()) write_whole(options_.out / "run.csv", samples_csv(samples_));
        if (!options_.screenshot.empty()) {
            if (std::filesystem::exists(options_.screenshot))
                std::printf("wrote %s\n", options_.screenshot.c_str());
            else
                std::fprintf(stderr, "no screenshot %s: the window ended too early\n",
                             options_.screenshot.c_str());
        }
        if (!options_.save.empty() && !(next_ && next_->extends))
            system_->save(region, {facts_.scene, options_.save, options_.programs}, signals_);
        return facts_.intended ? 0 : 1;
    }

    void note(const std::string& name, const Ending& e) {
        facts_.endings[name] = e;
        if (e.clean() && (e.asked || facts_.intended)) return;
        // SIGTERM may end a program before its handler is installed; that is a requested end.
        if (e.asked && e.by_signal && e.number == SIGTERM) return;
        facts_.intended = false;
        std::fprintf(stderr, "%s %s\n  fix: %s\n", name.c_str(), e.text().c_str(), advice(name, e).c_str());
    }

    [[nodiscard]] double samples_length() const { return to_s(ended_at() - *seen_at_); }
    [[nodiscard]] Instant ended_at() const {
        const auto health = observer_.seen() ? newest(observer_.region().health) : std::nullopt;
        return health ? instant_from_ns(health->taken_at_ns) : Monotonic::now();
    }

    RunOptions options_;
    SceneSwitch* scene_switch_;  // null: the window cannot request scenes
    bool first_;
    std::optional<Asked> next_;
    Asked asked_;
    RunDescription facts_;
    SceneFile file_;
    std::unique_ptr<SystemRun> system_;
    Signals signals_;
    Observer observer_;
    std::optional<ScratchFolder> scratch_;  // must outlive the X server, which uses it
    std::optional<XServer> x_;
    std::vector<std::pair<std::string, std::string>> display_;
    std::optional<Child> rt_, gui_, record_, flight_, keeper_;
    std::optional<LookBack> past_;
    bool ending_ = false;
    int lines_ = 0;
    Instant started_{}, sample_due_{}, line_due_{}, core_due_{}, asked_due_{};
    std::optional<Instant> seen_at_;
    std::vector<Sample> samples_;
    std::vector<double> fps_;
};

// What returns if `now` does not start: `before`, with its bodies where the window says that they are.
Asked way_back(const Asked& now, Asked before) {
    if (now.back.empty()) return before;
    try {
        return asked_of(now.back);
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact: %s\n", e.what());
        return before;
    }
}

}  // namespace

int run_scene(const std::filesystem::path& scene, RunOptions options) {
    options.settle();
    std::optional<SceneSwitch> scene_switch;
    if (options.gui && !options.headless) scene_switch.emplace(options);
    Asked now = asked_of(scene), before;
    for (bool first = true;; first = false) {
        int code = 1;
        bool came_up = false;
        std::optional<Asked> next;
        try {
            OneRun run(now, options, scene_switch ? &*scene_switch : nullptr, first);
            code = run.go();
            came_up = run.came_up();
            next = run.next();
        } catch (const StartupError& e) {
            if (before.scene.empty()) throw;
            std::fprintf(stderr, "tact: %s\n", e.what());
        }
        if (next && code == 0) {
            before = std::exchange(now, *next);
            before = way_back(now, std::move(before));
            options.forget_scene();
        } else if (code != 0 && !came_up && !before.scene.empty()) {
            scene_switch->refuse(
                "opening " + (now.bone.empty() ? now.scene : now.bone).string() +
                ": the scene could not be started with the options of this run; the terminal shows "
                "the messages of the programs\n  fix: close the window and start: tact run " +
                now.scene.string() + (now.bone.empty() ? "" : " --resume " + now.bone.string()));
            now = std::exchange(before, {});
        } else {
            return code;
        }
    }
}

}  // namespace tact::launch
