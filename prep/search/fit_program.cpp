#include "prep/search/fit_program.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <cstdio>
#include <new>

#include "ipc/base/parent_death.hpp"
#include "ipc/base/progress.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"

namespace tact {

int run_fit_program(const char* name, const std::string& about, void (*set_up)(CLI::App&), int argc,
                    char** argv) {
    CLI::App app(about, name);
    app.set_version_flag("--version", program_version(name), "Print the version and exit");
    app.footer("Exit codes: 0 done; 1 error; 2 wrong usage; 130 cancelled by Ctrl-C, nothing written.");
    set_up(app);
    try {
        if (const auto answered = manual::answer(app, name, argc, argv)) return *answered;
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const Cancelled&) {
        std::fprintf(stderr, "%s: cancelled; nothing was written\n", name);
        return 130;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "%s: out of memory\n  fix: free memory, or crop or bin the map\n", name);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
    }
    return 1;
}

void ServedProgram::add_to(CLI::App& command) {
    command
        .add_option("--ends-with", ends_with,
                    "Cancel when the process with this id ends (for programs that start this one)")
        ->type_name("PID");
    command.add_flag("--background", background, "Yield the processors to other programs");
}

void ServedProgram::apply() const {
    if (background) (void)setpriority(PRIO_PROCESS, 0, 10);  // lowering it never fails; threads inherit it
    if (ends_with != 0 && !end_with_parent(ends_with, SIGTERM)) throw Cancelled{};
}

}  // namespace tact
