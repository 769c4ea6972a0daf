// tact-certify: runs the live model of a scene against an independent reference. `tact certify` starts it.
//
// Exit  0  every promise was kept; 1  one was not, or an error; 2  wrong usage
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "tests/reference/certify.hpp"

namespace tact {
namespace {

using nlohmann::json;

struct Options {
    std::string scene;
    CertifySettings settings;
    bool as_json = false;
};

void print(const reference::Promises& promises) {
    std::printf("%-26s %9s %10s %11s\n", "promise", "steps", "violations", "worst ratio");
    for (const reference::Promise& p : promises) {
        std::printf("%-26s %9llu %10llu %11.3f\n", p.name.c_str(), static_cast<unsigned long long>(p.steps),
                    static_cast<unsigned long long>(p.violations), p.worst_ratio);
        if (p.violations > 0)
            std::printf("    broken: %s\n    worst: %s\n", p.meaning.c_str(), p.worst_at.c_str());
    }
}

int run(Options& options) {
    const bool shown = isatty(STDERR_FILENO) != 0;
    options.settings.progress = [shown](double fraction, const char* what) {
        if (shown) std::fprintf(stderr, "\r%3.0f %%  %-20s", 100.0 * fraction, what);
        return true;
    };
    const SceneFile scene = SceneFile::open(options.scene);
    const reference::Promises promises = certify(scene, options.settings);
    if (shown) std::fprintf(stderr, "\r%30s\r", "");
    bool kept = true;
    json all = json::array();
    for (const reference::Promise& p : promises) {
        kept = kept && p.violations == 0;
        all.push_back({{"name", p.name},
                       {"meaning", p.meaning},
                       {"steps", p.steps},
                       {"violations", p.violations},
                       {"worst_ratio", p.worst_ratio},
                       {"worst_at", p.worst_at}});
    }
    if (options.as_json)
        std::printf("%s\n", json{{"scene", options.scene}, {"promises", all}}.dump(2).c_str());
    else
        print(promises);
    return kept ? 0 : 1;
}

}  // namespace
}  // namespace tact

int main(int argc, char** argv) {
    CLI::App app{
        "tact-certify: runs the live model of a scene against an independent reference in double precision, "
        "and counts for each promise the steps that broke it"};
    app.set_version_flag("--version", tact::program_version("tact-certify"));
    app.footer("Exit codes: 0 every promise was kept; 1 one was not, or an error; 2 wrong usage.");
    tact::Options options;
    app.add_option("SCENE", options.scene, "Baked scene")->required()->check(CLI::ExistingFile);
    app.add_option("--poses", options.settings.poses, "Number of poses, half of them along paths of a hand")
        ->check(CLI::Range(16, 10'000'000))
        ->capture_default_str();
    app.add_option("--seed", options.settings.seed, "Seed of the poses")->capture_default_str();
    app.add_flag("--json", options.as_json, "Print as JSON");
    if (const auto answered = tact::manual::answer(app, "tact-certify", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        return tact::run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-certify: %s\n", e.what());
        return 1;
    }
}
