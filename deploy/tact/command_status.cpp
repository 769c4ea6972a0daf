// tact status: prints the state of the running controller.
#include <poll.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/run_record.hpp"
#include "deploy/tact/run_report.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/systems.hpp"

namespace tact::launch {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);

struct StatusOptions {
    std::string session = "default";
    bool json = false, watch = false;
};

// Null if the scene file was moved since the start; the columns of the system are then missing.
std::unique_ptr<SystemRun> system_run_of(const RtRegion& region) {
    try {
        const SceneFile scene = SceneFile::open(field_text(region.scene_path, sizeof region.scene_path));
        return system_of(scene).open_run(scene);
    } catch (const std::exception&) {
        return nullptr;
    }
}

void show(const Observer& observer, bool as_json) {
    nlohmann::json report = controller_report(observer.region());
    if (as_json) {
        std::fputs(report_text(report).c_str(), stdout);
        return;
    }
    const auto system = system_run_of(observer.region());
    const auto sample = take_sample(observer.region(), system.get(), 0.0);
    if (!sample) return;
    std::printf("state %s: %s\nscene %s\n", report["state"].get<std::string>().c_str(),
                report["reason"].get<std::string>().c_str(),
                report["scene"]["path"].get<std::string>().c_str());
    if (report.contains("lines")) {
        std::printf("safety inputs %s: %s\n", report["lines"]["state"].get<std::string>().c_str(),
                    report["lines"]["reason"].get<std::string>().c_str());
    }
    for (const nlohmann::json& device : report["devices"]) {
        const std::string notice = device["notice"].get<std::string>();
        if (!notice.empty()) std::printf("device: %s\n", notice.c_str());
        if (device["bus"].is_null()) continue;
        std::string wrong;
        for (const auto& [name, n] : device["bus"].items()) {
            if (name != "packets" && n != 0)
                wrong += (wrong.empty() ? "; " : ", ") + name + " " + std::to_string(n.get<std::uint32_t>());
        }
        std::printf("device bus: %u packets%s\n", device["bus"]["packets"].get<std::uint32_t>(),
                    wrong.c_str());
    }
    std::printf("law %s, goal %.0f Hz\n",
                report["governor"].is_object() ? report["governor"]["law"].get<std::string>().c_str() : "-",
                sample->health.goal_hz);
    if (report["governor"].is_object()) {
        for (const auto& [name, path] : report["governor"]["paths"].items()) {
            std::printf("level %s %.2f: %s", name.c_str(), path["level"].get<double>(),
                        path["status"].get<std::string>().c_str());
            if (path["drawn"].is_number() && report["gui"]["attached"].get<bool>())
                std::printf("; %u of %u drawn", path["drawn"].get<std::uint32_t>(),
                            path["items_max"].get<std::uint32_t>());
            std::fputc('\n', stdout);
        }
    }
    std::fputs(report_summary(report).c_str(), stdout);
    std::fputs((table_header(*sample) + table_row(*sample)).c_str(), stdout);
}

int watch(Observer& observer, bool as_json) {
    Signals signals;
    std::unique_ptr<SystemRun> system;
    Instant due{}, began = Monotonic::now();
    std::uint64_t generation = 0;
    bool said_waiting = false;
    int lines = 0;
    while (signals.wait(50) == 0) {
        observer.poll();
        if (!observer.attached()) {
            if (!said_waiting && !as_json) std::printf("%s\n", observer.status_text().c_str());
            said_waiting = true;
            std::fflush(stdout);
            continue;
        }
        if (!observer.seen() || Monotonic::now() < due) continue;
        if (generation != observer.generation()) {
            generation = observer.generation();
            system = system_run_of(observer.region());
            began = Monotonic::now();
        }
        said_waiting = false;
        due = Monotonic::now() + std::chrono::seconds(1);
        if (as_json) {
            const nlohmann::json report = controller_report(observer.region());
            std::printf("%s\n",
                        report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
            std::fflush(stdout);
            continue;
        }
        const auto sample = take_sample(observer.region(), system.get(), to_s(Monotonic::now() - began));
        if (!sample) continue;
        if (lines++ % 20 == 0) std::fputs(table_header(*sample).c_str(), stdout);
        std::fputs(table_row(*sample).c_str(), stdout);
        std::fflush(stdout);
    }
    return 0;
}

int status(const StatusOptions& o) {
    Observer observer(o.session);
    if (o.watch) return watch(observer, o.json);
    const Instant end = Monotonic::now() + kPatience;
    while (Monotonic::now() < end) {
        observer.poll();
        if (observer.seen() && newest(observer.region().health)) {
            show(observer, o.json);
            return 0;
        }
        ::poll(nullptr, 0, 20);
    }
    std::fprintf(stderr,
                 "%s\n  fix: start a controller with tact demo dock, or give its session with --session\n",
                 observer.status_text().c_str());
    return 1;
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "status", "Print the state and rates of the running controller; exit code 1: none runs");
    const auto o = std::make_shared<StatusOptions>();
    command->add_option("--session", o->session, "Session name")->type_name("NAME")->capture_default_str();
    command->add_flag("--json", o->json, "Print as JSON; with --watch one object per line");
    command->add_flag("--watch", o->watch,
                      "Print one line per second, also across restarts of the controller, until Ctrl-C");
    command->callback([o, &exit_code] { exit_code = status(*o); });
}

}  // namespace tact::launch
