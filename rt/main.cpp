// tact-rt: closes the force loop on a baked scene.
//
// Exit  0  the run ended normally, by a signal or after its time
//       1  it could not start; one message gives problem, cause and fix. With --check-config: the file has problems
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "hal/registry.hpp"
#include "ipc/base/error.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/shm/servo_threads.hpp"
#include "ipc/topics/text.hpp"
#include "rt/config/check_config.hpp"
#include "rt/config/config.hpp"
#include "rt/servo/rt_guard.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/run_text.hpp"
#include "rt/start/start_options.hpp"
#include "rt/start/start_station.hpp"
#include "rt/start/systems.hpp"
#include "rt/threads/head_feed.hpp"
#include "rt/threads/housekeeping.hpp"
#include "rt/threads/journal_format.hpp"
#include "rt/threads/log_sink.hpp"
#include "rt/threads/servo_thread.hpp"
#include "rt/threads/slow_update_thread.hpp"
#include "rt/threads/supervisor.hpp"
#include "rt/threads/thread_setup.hpp"

namespace {

using namespace tact;

struct LevelRequest {
    std::uint32_t path;
    double level;
};

LevelRequest parse_level(const std::string& text, const std::vector<std::string>& paths, const Servo& servo) {
    const auto equals = text.find('=');
    char* end = nullptr;
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    const double level = std::strtod(value.c_str(), &end);
    std::string known;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        known += (i == 0 ? "" : ", ") + paths[i];
        if (text.substr(0, equals) != paths[i] || value.empty() || *end != 0) continue;
        const float floor = servo.governor().paths()[i].knob.floor;
        // In the precision of the floor, so that the printed floor is accepted.
        if (static_cast<float>(level) >= floor && level <= 1.0) return {static_cast<std::uint32_t>(i), level};
        throw StartupError("--level " + text, "the level is outside " + std::to_string(floor) + " to 1",
                           "choose a level inside the range");
    }
    throw StartupError("--level " + text, "the argument is not PATH=VALUE with a path of this scene",
                       "use one of the paths " + known);
}

void say_how_it_went(const RtRegion& region) {
    HealthTopic h{};
    LatenessTopic l{};
    if (!region.health.read(h) || !region.lateness.read(l)) return;
    const auto us = [&](double p) {
        return static_cast<double>(DurationHistogram::percentile_ns(l.counts, l.total, l.max_ns, p)) * 1e-3;
    };
    spdlog::info("{:.1f} updates a second over {} cycles; {} overruns, {} periods skipped",
                 h.force_rate_mean_hz, h.cycle, h.overruns, h.skipped);
    if (l.total > 0) {
        spdlog::info("lateness p50 {:.2f} us, p99 {:.2f}, p99.9 {:.2f}, max {:.2f}", us(0.5), us(0.99),
                     us(0.999), static_cast<double>(l.max_ns) * 1e-3);
    }
    spdlog::info("on the servo thread inside cycles: {} heap calls, {} locks, {} page faults", h.allocations,
                 h.locks, h.page_faults);
}

int run(std::span<char* const> arguments, const StartOptions& o, const StartOverrides& overrides) {
    const RtConfig config = configure(o, overrides);
    const DeviceEntry& driver = device_driver(config.device.driver);
    const bool two_hands = config.device2.driver != "none";
    const bool emulated = driver.emulated && (!two_hands || device_driver(config.device2.driver).emulated);
    const SceneFile scene = SceneFile::open(o.scene);

    // Regions come first: the session lock needs them, and without the lock a second controller could open the device.
    OwnedRegion<RtRegion> region;
    std::memset(static_cast<void*>(&*region), 0, sizeof(RtRegion));  // faults in its pages
    const std::string path = std::filesystem::absolute(o.scene).string();
    std::memcpy(region->scene_path, path.data(), std::min(path.size(), sizeof region->scene_path - 1));
    region->scene_checksum = scene.checksum();
    tell_how_started(arguments, o, region->run_text);
    region.mark_ready();
    const SceneSystem system({scene, o, config, *region});
    std::optional<LinkServer> link;
    if (!o.check) link.emplace(o.session, region.fd(), system.fd());

    std::unique_ptr<ForceModel> model = system.make_model(0);
    std::unique_ptr<ForceModel> second;
    if (two_hands) second = system.make_model(1);
    // Until here a signal ends the process at once; it holds no device yet. From here on a signal ends the run in order.
    // Static, because a signal may also arrive after run().
    static ServoMailbox mailbox;
    Housekeeping::catch_signals(mailbox);
    DeviceSettings of_device = device_settings_from(config);
    of_device.say = [](const char* text) { spdlog::warn("{}", text); };
    // Static, as the mailbox.
    static Latest<MouseTarget> targets[kHandsMax]{};
    const std::array<bool, kHandsMax> led = mouse_hands(config);
    if (led[0]) of_device.sim.mouse = &targets[0];
    const std::unique_ptr<HapticDevice> device = driver.make(of_device);
    const DeviceInfo info = device->open();
    std::unique_ptr<HapticDevice> device2;
    DeviceInfo info2;
    if (two_hands) {
        DeviceSettings of_second = device2_settings_from(config);
        of_second.say = of_device.say;
        if (led[1]) of_second.sim.mouse = &targets[1];
        device2 = device_driver(config.device2.driver).make(of_second);
        info2 = device2->open();
    }
    const std::string hands_on = info.name + (two_hands ? " and " + info2.name : "");
    std::optional<HeadFeed> head;
    if (std::unique_ptr<Tracker> tracker = make_tracker(tracker_settings_from(config)))
        head.emplace(head_settings_from(config), std::move(tracker), region->head, region->tracker);
    const std::string head_on = head ? head->open().name : "no head tracker";
    const std::unique_ptr<Lines> lines = make_lines(lines_settings_from(config));
    const std::string lines_on = lines ? lines->open().name : "no safety inputs";
    ServoSettings settings = settings_from(config, emulated);
    settings.visual_paths = system.visual_paths();
    const std::array hands{HandParts{device.get(), model.get(), info, system.drive(0)},
                           HandParts{device2.get(), second.get(), info2, system.drive(1)}};

    ServoClock clock = servo_clock(config.servo);
    Servo servo({.clock = clock,
                 .hands = std::span(hands).first(two_hands ? 2 : 1),
                 .region = *region,
                 .mailbox = mailbox,
                 .lines = lines.get()},
                settings);
    // The servo may swap models; its last ones are destroyed here, off its thread.
    struct LastModel {
        Servo& servo;
        ~LastModel() {
            for (std::uint32_t i = 0; i < servo.state().hands; ++i) delete servo.state().hand[i].model;
        }
    } const last_model{servo};
    static_cast<void>(model.release());
    static_cast<void>(second.release());

    std::vector<std::string> paths;  // in the governor's order
    for (const GovernedPath& p : servo.governor().paths()) paths.emplace_back(p.knob.path);
    std::vector<LevelRequest> requests;
    for (const std::string& text : o.levels) requests.push_back(parse_level(text, paths, servo));
    if (o.check) {
        device->relax();
        if (two_hands) device2->relax();
        std::printf("tact-rt: scene %s, device %s, %s, %s, configuration: no problems\n", o.scene.c_str(),
                    hands_on.c_str(), head_on.c_str(), lines_on.c_str());
        return 0;
    }

    for (const LevelRequest& w : requests) servo.start_at_level(w.path, w.level);
    Platform platform;
    const ScheduleRequest schedule{.priority = static_cast<int>(config.servo.priority),
                                   .core = static_cast<int>(config.servo.core),
                                   .lock_memory = config.servo.lock_memory,
                                   .limit_processor_time = sleeps(config.servo)};
    ServoThread thread(servo, schedule, platform, mailbox);
    prepare_process(schedule, platform);
    thread.start();
    for (const std::string& finding : platform.findings) spdlog::warn("{}", finding);
    if (const std::string shared = shared_core_text(pinned_servos(), getpid()); !shared.empty())
        spdlog::warn("{}.\n  fix: {}", shared, kSharedCoreFix);
    if (emulated && config.safety.timing_latches == "real") {
        spdlog::info("emulated device: lateness is counted and displayed, but latches no fault");
    }
    spdlog::info("{} on {}; {}; {}; {}; session {}", o.scene, hands_on, head_on, lines_on,
                 schedule_text(platform.flags), o.session);
    log_station_report();
    if (head) head->start();
    std::optional<Supervisor> supervisor;
    // Emulated lines protect nothing: they need the supervisor only if lateness latches.
    if (lines && (config.lines.driver != "sim" || settings.watchdogs.timing_latches)) {
        supervisor.emplace(mailbox.pulse, duration_us(config.safety.supervisor_us_max),
                           [&lines] { lines->drop(); });
        supervisor->start(thread.id());
    }

    std::optional<SlowUpdateThread> slow_updates;
    if (hands[0].model->has_slow_update())
        slow_updates.emplace(*hands[0].model, region->tool[0], thread.id());

    Housekeeping housekeeping({.session = o.session,
                               .seconds = o.seconds,
                               .arm_with_gui = o.arm_with_gui && !o.arm,
                               .path_names = paths,
                               .servo_thread_id = thread.id(),
                               .page_faults_at_start = thread.faults_at_start(),
                               .mouse = {led[0] ? &targets[0] : nullptr, led[1] ? &targets[1] : nullptr},
                               .T_dev_world = settings.T_world_dev.inverse(),
                               .lead_device = lead_devices(config)},
                              region, mailbox, *link);
    if (o.arm) housekeeping.order(CommandKind::arm, 0.0, 0);
    housekeeping.run();
    thread.join();
    device->relax();
    if (two_hands) device2->relax();
    release_process(platform);
    say_how_it_went(*region);
    if (const std::string summary = system.summary(); !summary.empty()) spdlog::info("{}", summary);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("tact-rt", make_log_sink(STDERR_FILENO)));
    const bool journal = is_journal_stream(STDERR_FILENO);
    spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$ %v");
    if (journal) spdlog::set_formatter(make_journal_formatter());
    tact::rt_guard::install();
    CLI::App app{"tact-rt: closes the force loop on a baked scene"};
    app.footer("Exit codes: 0 success; 1 error; 2 wrong usage.");
    StartOptions options;
    StartOverrides overrides;
    describe(app, options, overrides);
    if (const auto answered = manual::answer(app, "tact-rt", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        if (!options.check_config.empty())
            return print_config_check(std::cout, options.check_config, options.json);
        return run(std::span(argv, static_cast<std::size_t>(argc)).subspan(1), options, overrides);
    } catch (const std::exception& e) {
        journal ? spdlog::error("{}", e.what())
                : static_cast<void>(std::fprintf(stderr, "tact-rt: %s\n", e.what()));
        return 1;
    }
}
