// tact-record: writes the contents of a controller's rings to an HDF5 file; keeps a flight recorder;
// repairs files of killed recorders; converts recordings to text tables; keeps drilled bone.
//
// Exit  0  success: the recording is complete, or the file was repaired or needed no repair
//      1  error, or the disk was (nearly) full: what was written up to then is complete
//      2  wrong usage
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <nlohmann/json.hpp>

#include "ipc/manual/manual.hpp"
#include "ipc/record/repair.hpp"
#include "ipc/recorder/bone_keeper.hpp"
#include "ipc/recorder/csv.hpp"
#include "ipc/recorder/flight.hpp"
#include "ipc/recorder/recorder.hpp"
#include "ipc/version/version.hpp"

namespace {

using namespace tact;
using namespace tact::record;

volatile sig_atomic_t stop_asked = 0;
volatile sig_atomic_t save_asked = 0;
extern "C" void on_stop(int) { stop_asked = 1; }
extern "C" void on_save(int) { save_asked = 1; }

struct Requests {
    RecorderSettings settings;
    FlightSettings flight;
    CsvSettings csv;
    BoneKeeperSettings bone;
    std::string file, repair, folder, table, output;
    double length_s = 30.0;
    bool json = false, quiet = false;
};

int repair_file(const Requests& w) {
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

int make_recording(Requests& w) {
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
        std::printf("nothing recorded: stopped before a controller was available\n");
    } else {
        std::printf("%s: %llu cycles, %.1f MB, %s; %llu records lost; %s\n", name.c_str(),
                    static_cast<unsigned long long>(p.cycles), static_cast<double>(p.bytes) * 1e-6,
                    p.first_step == 1 ? "from the controller's start" : "started in the middle of a run",
                    static_cast<unsigned long long>(p.dropped), recorder_end_text(outcome.end));
    }
    if (outcome.end != RecorderEnd::disk_full) return 0;
    std::fprintf(stderr, "tact-record: the disk is nearly full; the recording ends here and is complete\n");
    return 1;
}

int keep_flights(Requests& w) {
    w.flight.folder = w.folder;
    w.flight.session = w.settings.session;
    w.flight.program = w.settings.program;
    w.flight.seconds = w.settings.seconds;
    w.flight.wait_s = w.settings.wait_s;
    w.flight.length = Duration(static_cast<std::int64_t>(w.length_s * 1e9));
    w.flight.stop = [] { return stop_asked != 0; };
    w.flight.save = [] {
        const bool asked = save_asked != 0;
        save_asked = 0;
        return asked;
    };
    const FlightOutcome outcome = fly(w.flight, [&](const std::string& text) {
        if (!w.quiet) std::fprintf(stderr, "tact-record: %s\n", text.c_str());
    });
    if (w.json)
        std::printf("%s\n", nlohmann::json{{"folder", w.folder},
                                           {"files", outcome.files},
                                           {"failed", outcome.failed},
                                           {"lost", outcome.dropped}}
                                .dump()
                                .c_str());
    else
        std::printf("%s: %llu flight recordings saved, %llu failed; %llu records lost\n", w.folder.c_str(),
                    static_cast<unsigned long long>(outcome.files),
                    static_cast<unsigned long long>(outcome.failed),
                    static_cast<unsigned long long>(outcome.dropped));
    return outcome.failed == 0 ? 0 : 1;
}

int keep_drilled_bone(Requests& w) {
    w.bone.session = w.settings.session;
    w.bone.wait_s = w.settings.wait_s;
    w.bone.seconds = w.settings.seconds;
    w.bone.stop = [] { return stop_asked != 0; };
    const BoneKept kept = keep_bone(w.bone, [&](const std::string& text) {
        if (!w.quiet) std::fprintf(stderr, "tact-record: %s\n", text.c_str());
    });
    const std::string name = w.bone.file.string();
    if (w.json)
        std::printf("%s\n", nlohmann::json{{"file", kept.drilled ? name : ""},
                                           {"cuts", kept.strokes},
                                           {"bytes", kept.bytes},
                                           {"complete", kept.complete}}
                                .dump()
                                .c_str());
    else if (!kept.drilled)
        std::printf("no bone was drilled: no file was written\n");
    else
        std::printf("%s: %u cuts, %.1f MB\n", name.c_str(), kept.strokes,
                    1e-6 * static_cast<double>(kept.bytes));
    if (kept.complete) return 0;
    std::fprintf(stderr, "tact-record: the last changes of the bone could not be written to %s\n",
                 name.c_str());
    return 1;
}

int make_table(Requests& w) {
    w.csv.recording = w.table;
    w.csv.file = w.output;
    const std::uint64_t rows = write_csv(w.csv, [] { return stop_asked != 0; });
    if (w.json)
        std::printf("%s\n", nlohmann::json{{"file", w.output}, {"rows", rows}}.dump().c_str());
    else
        std::printf("%s: %llu rows\n", w.output.c_str(), static_cast<unsigned long long>(rows));
    return 0;
}

int run_request(Requests& w) {
    if (!w.repair.empty()) return repair_file(w);
    if (!w.table.empty()) return make_table(w);
    if (!w.folder.empty()) return keep_flights(w);
    if (!w.bone.file.empty()) return keep_drilled_bone(w);
    w.settings.file = w.file;
    return make_recording(w);
}

void describe(CLI::App& app, Requests& w) {
    auto* const what = app.add_option_group(
        "What",
        "Action: record to a file (default), keep a flight recorder or drilled bone, repair or convert");
    what->add_option("file", w.file, "New recording of every servo cycle, such as run.h5")
        ->type_name("FILE.h5");
    what->add_option("--flight", w.folder,
                     "Folder for flight recordings: the last seconds, kept in memory and saved at an "
                     "overrun, a fault, "
                     "the key M in the window or SIGUSR1")
        ->type_name("DIR");
    what->add_option("--repair", w.repair,
                     "Recording to repair after its recorder was killed; prints the amount of lost data")
        ->type_name("FILE.h5");
    auto* const csv =
        what->add_option("--csv", w.table, "Recording to convert into a table (CSV)")->type_name("FILE.h5");
    auto* const bone = what->add_option("--bone", w.bone.file,
                                        "New file for the drilled bone of a run, written while it is drilled")
                           ->type_name("FILE.bone");
    what->require_option(1);
    app.add_option("--bone-from", w.bone.resumed, "File of drilled bone with which the run started")
        ->type_name("FILE.bone")
        ->needs(bone);
    app.add_option("--session", w.settings.session, "Session name of the controller")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--seconds", w.settings.seconds,
                   "Length of the recording (s); 0: until the controller ends")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--wait", w.settings.wait_s, "Time to wait for a controller (s); 0: no limit")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    app.add_option("--length", w.length_s, "Length of a flight recording (s)")
        ->type_name("S")
        ->check(CLI::Range(1.0, 600.0))
        ->capture_default_str();
    app.add_option("--keep", w.flight.files_max,
                   "Number of flight recordings to keep; older ones are removed")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    auto* const output =
        app.add_option("-o,--output", w.output, "Table to write (CSV)")->type_name("FILE.csv")->needs(csv);
    csv->needs(output);
    app.add_option("--every", w.csv.every, "Number of cycles per row of the table")
        ->check(CLI::Range(1, 1000000))
        ->needs(csv);
    app.add_flag("--json", w.json, "Print the result as JSON");
    app.add_flag("--quiet", w.quiet, "Print only the result and errors");
    app.set_version_flag("--version", program_version("tact-record"));
}

}  // namespace

int main(int argc, char** argv) {
    Requests w;
    w.settings.program = program_version("tact-record");
    CLI::App app{
        "tact-record: records every servo cycle of a controller to an HDF5 file.\nCtrl-C ends the recording; "
        "kill -9 loses at most a second."};
    app.footer(
        "Exit codes: 0 success: the recording is complete, or the file was repaired or needed no repair; 1 "
        "error, or the disk was (nearly) full: what was written up to then is complete; 2 wrong usage.");
    describe(app, w);
    if (const auto answered = manual::answer(app, "tact-record", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    struct sigaction action {};
    action.sa_handler = &on_stop;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    action.sa_handler = &on_save;
    sigaction(SIGUSR1, &action, nullptr);
    signal(SIGXFSZ, SIG_IGN);  // reports a file above the size limit as a write error
    try {
        return run_request(w);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-record: %s\n", e.what());
        std::fflush(nullptr);
        _exit(1);  // at exit, HDF5 would try again to write to the full disk
    }
}
