// tact replay: repeats a recorded run and compares it with the recording; with --show in a window, at the recorded
// speed.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/replay_continue.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/x_server.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact::launch {
namespace {

struct ReplayOptions {
    std::string file, scene, bone, session = "replay", size = "1280x800", screenshot, texts, into;
    bool show = false, json = false, headless = false;
    double from_s = 0.0, speed = 1.0, seconds = 0.0;
};

std::vector<std::string> words_of(const ReplayOptions& o) {
    std::vector<std::string> words{o.file};
    if (!o.scene.empty()) words.insert(words.end(), {"--scene", o.scene});
    if (!o.bone.empty()) words.insert(words.end(), {"--bone", o.bone});
    if (o.json) words.emplace_back("--json");
    if (o.show)
        words.insert(words.end(), {"--show", "--session", o.session, "--from", std::to_string(o.from_s),
                                   "--speed", std::to_string(o.speed), "--can-run"});
    return words;
}

std::optional<XServer> screen_of(const ReplayOptions& o, const ScratchFolder& scratch) {
    if (!o.headless) {
        if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr)
            throw StartupError("opening a window", "neither DISPLAY nor WAYLAND_DISPLAY is set",
                               "add --headless to draw without a screen, or omit --show");
        return std::nullopt;
    }
    return std::make_optional<XServer>(scratch.path(), o.size);
}

// Runs until window and replay have ended; the one that ends first stops the other.
int show(const ReplayOptions& o) {
    const ScratchFolder scratch;
    Signals signals;
    std::optional<XServer> screen = screen_of(o, scratch);
    ChildSettings replaying, drawing;
    replaying.arguments = words_of(o);
    drawing.arguments = {"--session", o.session, "--size", o.size};
    if (!o.screenshot.empty())
        drawing.arguments.insert(drawing.arguments.end(), {"--screenshot", o.screenshot});
    if (!o.texts.empty()) drawing.arguments.insert(drawing.arguments.end(), {"--texts", o.texts});
    if (o.seconds > 0.0)
        drawing.arguments.insert(drawing.arguments.end(), {"--seconds", std::to_string(o.seconds)});
    if (screen) drawing.environment = screen->environment();
    drawing.grace = std::chrono::seconds(10);
    Child replay("tact-replay", find_program("tact-replay"), replaying);
    Child window("tact-gui", find_program("tact-gui"), drawing);
    Observer observer(o.session);
    std::filesystem::path moment;
    std::uint64_t runs = 0;
    while (!replay.poll() || !window.poll()) {
        if (signals.wait(20) != 0 || window.poll()) replay.stop();
        if (replay.poll()) window.stop();
        observer.poll();
        const auto shown = observer.seen() ? newest(observer.region().replay) : std::nullopt;
        if (!shown || shown->runs == runs || !moment.empty()) continue;
        runs = shown->runs;
        try {
            moment = keep_moment(observer.region(), *shown, o.session);
            replay.stop();
        } catch (const StartupError& e) {
            std::fprintf(stderr, "tact: %s\n", e.what());
        }
    }
    if (!moment.empty() && !o.into.empty()) {
        ask_for_scene(o.into, moment);
        return 0;
    }
    if (!moment.empty()) {
        std::vector<std::string> live{"run", moment.string(), "--disarmed"};
        if (o.headless) live.emplace_back("--headless");
        live.insert(live.end(), {"--size", o.size});
        if (!o.texts.empty()) live.insert(live.end(), {"--texts", o.texts});
        std::string line = "tact";
        for (const std::string& word : live) line += " " + word;
        std::fprintf(stderr, "live from this moment of the recording: %s\n", line.c_str());
        screen.reset();
        exec_program("tact", live);
    }
    const Ending& drawn = *window.poll();
    if (!drawn.clean() && !(drawn.asked && !drawn.forced)) {
        std::fprintf(stderr, "tact-gui %s\n  fix: see the messages of tact-gui above\n",
                     drawn.text().c_str());
        return 1;
    }
    const Ending& done = *replay.poll();
    return done.by_signal ? 1 : done.number;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto* const command =
        app.add_subcommand("replay",
                           "Repeat a recorded run in simulated time with the code of the controller, and "
                           "compare every force; exit code 0: bit-exact; 3: not");
    const auto o = std::make_shared<ReplayOptions>();
    command->add_option("FILE", o->file, "Recording of tact record, or of a run with --record")
        ->required()
        ->type_name("FILE.h5");
    command->add_option("--scene", o->scene, "Current path of the recorded scene")->type_name("SCENE");
    command->add_option("--bone", o->bone, "Current path of the drilled bone with which the run started")
        ->type_name("FILE.bone");
    command->add_flag("--json", o->json, "Print the result as JSON");
    auto* const shown =
        command->add_flag("--show", o->show, "Show the run in a window at the recorded speed");
    const auto number = [&](const char* name, double& value, double low, double high, const char* help) {
        command->add_option(name, value, help)->type_name("X")->check(CLI::Range(low, high))->needs(shown);
    };
    number("--from", o->from_s, -1e7, 1e7,
           "Time in the recording at which the display starts (s); negative: before its end");
    command->add_option("--into", o->into, "Folder of a run that goes on from the moment chosen; set by tact")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory)
        ->needs(shown);
    number("--speed", o->speed, 0.01, 100.0, "Speed of the display relative to the recording");
    number("--seconds", o->seconds, 0.0, 1e7,
           "Time after which the window closes (s); default: at the end of the recording");
    command->add_flag("--headless", o->headless, "Draw without a screen, on a private X server (Xvfb)")
        ->needs(shown);
    command->add_option("--size", o->size, "Size of the window (pixels)")->type_name("WxH")->needs(shown);
    command->add_option("--screenshot", o->screenshot, "Screenshot of the window at the end")
        ->type_name("FILE.png")
        ->needs(shown);
    command
        ->add_option("--texts", o->texts,
                     "Keep this file up to date with the texts on the window, for scripts that operate it by "
                     "its labels")
        ->type_name("FILE.json")
        ->needs(shown);
    command->add_option("--session", o->session, "Session name shared by window and replay")
        ->type_name("NAME")
        ->needs(shown);
    command->callback([o, &exit_code] {
        if (!o->show) exec_program("tact-replay", words_of(*o));
        exit_code = show(*o);
    });
}

}  // namespace tact::launch
