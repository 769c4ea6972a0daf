// tact-record: writes what a controller's rings hold into an HDF5 file; repairs files of recorders that were killed.
//
// Exit  0  as asked: the recording is whole, or the file was repaired or needed none
//       1  error, or the disk was nearly full: what was recorded till then is whole
//       2  wrong usage
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <nlohmann/json.hpp>

#include "deploy/record/recorder.hpp"
#include "ipc/record/repair.hpp"

namespace {

using namespace tact;
using namespace tact::record;

volatile sig_atomic_t stop_asked = 0;
extern "C" void on_stop(int) { stop_asked = 1; }

struct Wishes {
    RecorderSettings settings;
    std::string repair;
    bool json = false, quiet = false;
};

int repair_file(const Wishes& w) {
    const RepairReport r = repair_recording(w.repair);
    if (w.json) {
        std::printf("%s\n", nlohmann::json{{"file", w.repair},
                                           {"damaged", r.needed},
                                           {"cycles", r.cycles},
                                           {"rows_cut", r.rows_cut},
                                           {"last_ns", r.last_ns}}
                                .dump()
                                .c_str());
    } else {
        std::printf("%s\n", repair_text(w.repair, r).c_str());
    }
    return 0;
}

int make_recording(Wishes& w) {
    const bool terminal = isatty(STDERR_FILENO) == 1 && !w.quiet;
    const std::string name = w.settings.file.string();
    w.settings.stop = [] { return stop_asked != 0; };
    const RecorderOutcome outcome = record::record(
        w.settings,
        [&](const std::string& text) {
            if (!w.quiet) std::fprintf(stderr, "tact-record: %s\n", text.c_str());
        },
        [&](const RecorderProgress& p) {
            if (terminal)
                std::fprintf(stderr, "\r%s: %.1f s, %llu cycles, %.1f MB, %llu lost ", name.c_str(),
                             p.recorded_s, static_cast<unsigned long long>(p.cycles),
                             static_cast<double>(p.bytes) * 1e-6, static_cast<unsigned long long>(p.dropped));
        });
    const RecorderProgress& p = outcome.progress;
    if (terminal && outcome.began) std::fprintf(stderr, "\n");
    if (w.json) {
        std::printf("%s\n", nlohmann::json{{"file", outcome.began ? name : ""},
                                           {"end", recorder_end_text(outcome.end)},
                                           {"cycles", p.cycles},
                                           {"lost", p.dropped},
                                           {"bytes", p.bytes},
                                           {"recorded_s", p.recorded_s},
                                           {"from_start", p.first_step == 1}}
                                .dump()
                                .c_str());
    } else if (!outcome.began) {
        std::printf("nothing recorded: stopped before there was a controller\n");
    } else {
        std::printf("%s: %llu cycles, %.1f MB, %s; %llu records lost; %s\n", name.c_str(),
                    static_cast<unsigned long long>(p.cycles), static_cast<double>(p.bytes) * 1e-6,
                    p.first_step == 1 ? "from the controller's start" : "begun in the middle of a run",
                    static_cast<unsigned long long>(p.dropped), recorder_end_text(outcome.end));
    }
    if (outcome.end != RecorderEnd::disk_full) return 0;
    std::fprintf(stderr, "tact-record: the disk is nearly full; the recording ends here and is whole\n");
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    Wishes w;
    w.settings.program = "tact-record " TACT_VERSION;
    CLI::App app{
        "tact-record: writes what a controller's rings hold into an HDF5 file.\n"
        "Ctrl-C ends the recording; kill -9 loses at most a second."};
    std::string file;
    app.add_option("file", file, "to write, e.g. run.h5; must not be there");
    app.add_option("--session", w.settings.session, "name under which the controller is found")
        ->capture_default_str();
    app.add_option("--seconds", w.settings.seconds, "end after so long; 0: when the controller ends")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--wait", w.settings.wait_s, "seconds to wait for a controller; 0: as long as it takes")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--repair", w.repair,
                   "opens a recording whose recorder was killed, and says what was lost");
    app.add_flag("--json", w.json, "the outcome as JSON on standard output");
    app.add_flag("--quiet", w.quiet, "only the outcome and errors");
    app.set_version_flag("--version", TACT_VERSION);
    try {
        app.parse(argc, argv);
        if (file.empty() == w.repair.empty())
            throw CLI::ValidationError("name a file to write, or --repair FILE");
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    struct sigaction action {};
    action.sa_handler = &on_stop;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    signal(SIGXFSZ, SIG_IGN);  // a file too big is an error of a write
    w.settings.file = file;
    try {
        return w.repair.empty() ? make_recording(w) : repair_file(w);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-record: %s\n", e.what());
        std::fflush(nullptr);
        _exit(1);  // HDF5 would try at exit to write what the disk did not take
    }
}
