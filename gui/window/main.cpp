#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>

#include "gui/drilling/bench_particles.hpp"
#include "gui/window/app.hpp"
#include "gui/window/start_window.hpp"

int main(int argc, char** argv) {
    spdlog::set_default_logger(spdlog::stderr_color_mt("tact-gui"));
    spdlog::set_pattern("%n: %v");
    spdlog::cfg::load_env_levels();  // SPDLOG_LEVEL=debug logs each shortcut
    tact::GuiOptions options;
    int exit_code = 0;
    if (!tact::parse_gui_options(argc, argv, options, exit_code)) return exit_code;
    try {
        if (options.bench_particles) {
            std::printf("%s\n", tact::bench_particles().dump(2).c_str());
            return 0;
        }
        return options.start_page ? tact::run_start_page(options) : tact::run_gui(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-gui: %s\n", e.what());
        return 1;
    }
}
