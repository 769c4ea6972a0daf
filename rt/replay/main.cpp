// tact-replay: repeats a recorded run with the controller's own code and compares every force with the recording.
//
// Exit  0  bit-exact
//       1  error
//       2  wrong usage
//       3  not bit-exact, or the recording lacks data that an exact replay needs (reported)
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "ipc/base/error.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "rt/replay/replay_player.hpp"

namespace {

using namespace tact;

volatile sig_atomic_t stop_asked = 0;
extern "C" void on_stop(int) { stop_asked = 1; }

struct Requests {
    ReplaySettings settings;
    std::string session = "default";
    bool show = false, json = false, can_run = false;
    double from_s = 0.0, speed = 1.0;
};

void print_json(const Requests& w, const Replay& replay, const ReplayPlayer* player) {
    const ReplayResult& r = replay.result();
    nlohmann::json j{{"file", w.settings.recording.string()},
                     {"steps", r.steps},
                     {"different", r.different},
                     {"obstacle", replay.obstacle()},
                     {"recorded_by", replay.recording().about().controller},
                     {"repaired", replay.recording().about().repair.needed},
                     {"lost", replay.recording().about().dropped},
                     {"removed_levels", r.removed_levels},
                     {"force_n_most", r.force_n_most},
                     {"first_difference", nullptr}};
    if (r.first)
        j["first_difference"] = {{"step", r.first->step},         {"cycle", r.first->cycle},
                                 {"hand", r.first->hand},         {"what", r.first->what},
                                 {"recorded", r.first->recorded}, {"replayed", r.first->replayed}};
    j["shown"] = nullptr;
    if (player != nullptr)
        j["shown"] = {{"at_s", player->at_s()}, {"playing", player->playing()}, {"seeks", player->seeks()}};
    std::printf("%s\n", j.dump().c_str());
}

void print_words(const Replay& replay) {
    const ReplayResult& r = replay.result();
    const std::string& controller = replay.recording().about().controller;
    if (!controller.empty()) std::printf("recorded by %s\n", controller.c_str());
    if (!replay.obstacle().empty()) std::printf("not exact: %s\n", replay.obstacle().c_str());
    const std::uint64_t all = replay.recording().about().cycles;
    if (r.steps < all)
        std::printf("stopped after %llu of %llu steps\n", static_cast<unsigned long long>(r.steps),
                    static_cast<unsigned long long>(all));
    if (!r.first) {
        std::printf("%llu steps, up to %.3f N: every force is bit-exact\n",
                    static_cast<unsigned long long>(r.steps), r.force_n_most);
        return;
    }
    const ReplayDifference& d = *r.first;
    std::printf(
        "%llu of %llu steps differ; the first is step %llu (cycle %llu), hand %u: %s\n"
        "  recorded %.17g %.17g %.17g\n  replayed %.17g %.17g %.17g\n",
        static_cast<unsigned long long>(r.different), static_cast<unsigned long long>(r.steps),
        static_cast<unsigned long long>(d.step), static_cast<unsigned long long>(d.cycle), d.hand,
        d.what.c_str(), d.recorded[0], d.recorded[1], d.recorded[2], d.replayed[0], d.replayed[1],
        d.replayed[2]);
}

// player: of a replay that was shown; null: none was.
void print(const Requests& w, const Replay& replay, const ReplayPlayer* player) {
    if (w.json)
        print_json(w, replay, player);
    else
        print_words(replay);
}

int run(const Requests& w) {
    auto replay = std::make_unique<Replay>(w.settings);
    const RecordingReader::About& about = replay->recording().about();
    if (about.repair.needed) spdlog::warn("{}", repair_text(w.settings.recording, about.repair));
    if (about.dropped > 0) spdlog::warn("the recorder lost {} records", about.dropped);
    if (!replay->obstacle().empty()) spdlog::warn("this replay cannot be exact: {}", replay->obstacle());
    if (w.show) {
        ReplayPlayer player({.replay = w.settings,
                             .session = w.session,
                             .speed = w.speed,
                             .from_s = w.from_s,
                             .can_run = w.can_run},
                            std::move(replay));
        player.run([] { return stop_asked != 0; });
        const bool same = !player.differed();
        print(w, player.replay(), &player);
        return same && player.replay().obstacle().empty() ? 0 : 3;
    }
    const bool terminal = isatty(STDERR_FILENO) == 1;
    Instant said = Monotonic::now();
    while (replay->upcoming() != nullptr && stop_asked == 0) {
        replay->do_step();
        if (terminal && Monotonic::now() - said > std::chrono::milliseconds(500)) {
            said = Monotonic::now();
            std::fprintf(stderr, "\r%llu of %llu steps ",
                         static_cast<unsigned long long>(replay->result().steps),
                         static_cast<unsigned long long>(about.cycles));
        }
    }
    if (terminal) std::fprintf(stderr, "\r");
    print(w, *replay, nullptr);
    return replay->result().different == 0 && replay->obstacle().empty() ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
    spdlog::set_default_logger(spdlog::stderr_color_mt("tact-replay"));
    spdlog::set_pattern("%n %^%l%$ %v");
    Requests w;
    std::string file, scene, bone;
    CLI::App app{
        "tact-replay: repeats a recorded run with the code of the controller, and compares every force"};
    app.add_option("file", file, "Recording of tact record")->required()->type_name("FILE.h5");
    app.add_option("--scene", scene, "Current path of the recorded scene")->type_name("SCENE");
    app.add_option("--bone", bone, "Current path of the drilled bone with which the run started")
        ->type_name("FILE.bone");
    auto* show =
        app.add_flag("--show", w.show, "Show the run at the recorded speed in the window of the session");
    app.add_option("--session", w.session, "Session name of the window")
        ->type_name("NAME")
        ->capture_default_str()
        ->needs(show);
    app.add_option("--from", w.from_s,
                   "Time in the recording at which the display starts (s); negative: before its end")
        ->check(CLI::Range(-1e7, 1e7))
        ->needs(show);
    app.add_option("--speed", w.speed, "Speed of the display relative to the recording")
        ->check(CLI::Range(0.01, 100.0))
        ->needs(show);
    app.add_flag("--can-run", w.can_run,
                 "The window offers a live run from the moment shown; tact replay then starts it")
        ->needs(show);
    app.add_flag("--json", w.json, "Print the result as JSON");
    app.footer(
        "Exit codes: 0 bit-exact; 1 error; 2 wrong usage; 3 not bit-exact, or the recording lacks data that "
        "an exact replay needs.");
    app.set_version_flag("--version", program_version("tact-replay"));
    if (const auto answered = manual::answer(app, "tact-replay", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    struct sigaction action {};
    action.sa_handler = &on_stop;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    signal(SIGPIPE, SIG_IGN);
    w.settings.recording = file;
    w.settings.scene = scene;
    w.settings.bone = bone;
    try {
        return run(w);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-replay: %s\n", e.what());
        return 1;
    }
}
