// tact: the launcher.
//
// Exit codes  0 success; 1 an error, reported on standard error with its fix, or a process that died;
//             2 wrong usage; 130 ended by a signal before a run began.
#include <cstdio>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/start_page.hpp"
#include "deploy/tact/station/command_station.hpp"
#include "deploy/tact/systems.hpp"
#include "ipc/base/error.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"

int main(int argc, char** argv) {
    CLI::App app{
        "Tact: feel density maps, structures, surfaces, bone and fields. Without a command: a window with "
        "demos "
        "and recent scenes"};
    app.set_version_flag("--version", tact::program_version("tact"));
    app.require_subcommand(0, 1);
    app.footer("Exit codes: 0 success; 1 error or a process died; 2 wrong usage; 130 ended by a signal.");
    int exit_code = 0;
    std::string size = "1280x800", session, texts;
    app.add_option("--size", size, "Size of the start window, and of what it starts")
        ->type_name("WxH")
        ->capture_default_str();
    app.add_option("--session", session, "Session name of what it starts")->type_name("NAME");
    app.add_option("--texts", texts, "Keep this file up to date with the texts on the window, for scripts")
        ->type_name("FILE.json");
    using namespace tact::launch;
    add_demo(app, exit_code);
    for (const System& system : systems()) system.add_commands(app, exit_code);
    add_run(app, exit_code);
    add_calibrate(app, exit_code);
    add_record(app);
    add_replay(app, exit_code);
    add_status(app, exit_code);
    add_metrics(app, exit_code);
    add_igtl(app, exit_code);
    add_doctor(app, exit_code);
    add_station(app, exit_code);
    add_probe(app, exit_code);
    add_config(app);
    add_info(app, exit_code);
    add_bench(app);
    add_certify(app);
    add_reproduce(app);
    if (const auto answered = tact::manual::answer(
            app, "tact", argc, argv,
            {{"$XDG_CACHE_HOME/tact", "baked scenes; ~/.cache/tact if the variable is not set"},
             {"$XDG_STATE_HOME/tact", "recent scenes; ~/.local/state/tact if the variable is not set"}}))
        return *answered;
    try {
        app.parse(argc, argv);
        if (app.get_subcommands().empty()) {
            std::vector<std::string> words{"--size", size};
            if (!session.empty()) words.insert(words.end(), {"--session", session});
            if (!texts.empty()) words.insert(words.end(), {"--texts", texts});
            exit_code = run_start_page(words);
        }
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact: %s\n", e.what());
        return 1;
    }
    return exit_code;
}
