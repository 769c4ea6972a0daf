#include "rt/start_options.hpp"

#include <CLI/CLI.hpp>

#include "ipc/version/version.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

void describe(CLI::App& app, StartOptions& o, StartOverrides& v) {
    app.set_version_flag("--version", program_version("tact-rt"));
    auto* const scene = app.add_option("scene", o.scene, "baked scene, from tact-prep");
    auto* const check =
        app.add_option("--check-config", o.check_config,
                       "check this configuration without a scene and without a device, then exit")
            ->type_name("FILE")
            ->excludes(scene);
    app.add_flag("--json", o.json, "with --check-config: as JSON, with the value of every key")->needs(check);
    app.callback([&o] {
        if (o.scene.empty() && o.check_config.empty()) throw CLI::RequiredError("scene");
    });
    app.add_option("--session", o.session, "name under which the other programs find this one");
    app.add_option("--config", o.config, "TOML file; deploy/tact.toml shows every key");
    app.add_option("--seconds", o.seconds, "end after so long; 0: run until a signal")
        ->check(CLI::Range(0.0, 1e7));
    auto* rate = app.add_option("--rate", v.rate_hz, "servo rate in Hz")->check(CLI::Range(10.0, 20000.0));
    app.add_flag("--free-run", v.free_run, "as many updates as the processor gives")->excludes(rate);
    app.add_option("--law", v.law, "of the governor: elastic, sensitus or fixed");
    app.add_option("--goal", v.goal_hz, "of the governor, in Hz")->check(CLI::Range(1.0, 1e7));
    app.add_option("--picture-goal", v.picture_goal_hz, "of the governor, in frames a second; 0: none")
        ->check(CLI::Range(0.0, 1000.0));
    app.add_flag("--arm", o.arm, "arm at once instead of waiting for a command");
    app.add_flag(
        "--arm-with-gui", o.arm_with_gui,
        "arm once, when the visual process has drawn its first frame, so that a person sees all of it");
    app.add_option("--level", o.levels,
                   "PATH=VALUE: a fixed level, e.g. docking.force=1; the law becomes fixed");
    app.add_option("--core", v.core, "core of the servo thread; -1: chosen, -2: not pinned");
    app.add_option("--priority", v.priority, "FIFO priority; 0: ordinary scheduling")
        ->check(CLI::Range(0, 94));
    auto* offset = app.add_option("--start-offset-a", o.start_offset_a,
                                  "the first body starts so many angstroms from home")
                       ->check(CLI::Range(0.0, 1e4));
    auto* rotation =
        app.add_option("--start-rotation-deg", o.start_rotation_deg, "and turned by so many degrees")
            ->check(CLI::Range(0.0, 180.0));
    auto* copies =
        app.add_option(
               "--copies", o.copies,
               "so many bodies of the first structure; those behind the first stand free about the map")
            ->check(CLI::Range(1, static_cast<int>(ModelBodies::kMax)));
    app.add_option("--poses", o.poses,
                   "start with the bodies in this JSON file, as the report of a run lists them")
        ->excludes(offset)
        ->excludes(rotation)
        ->excludes(copies);
    app.add_option("--hand", v.hand,
                   "of the emulated device: passive, wander, stroke, drill, surgeon or sucker");
    app.add_option("--hand2", v.hand2,
                   "a second hand, emulated too, where the configuration has none; sucker: goes with the "
                   "surgeon in the first");
    app.add_option("--hand-at-mm", v.hand_at_mm, "X,Y: where an emulated surgeon works")
        ->delimiter(',')
        ->expected(2);
    app.add_option("--pedal", v.pedal, "of the burr: button (of the stylus), line (a foot pedal) or always");
    app.add_option("--burr-mm", v.burr_mm, "its diameter");
    app.add_option("--burr-shape", v.burr_shape, "sphere, cylinder or cone");
    app.add_option("--burr-rpm", v.burr_rpm, "its speed");
    app.add_option("--tool-radius-mm", o.tool_radius_mm,
                   "of the ball that touches a surface, in the hand's space; 0: a point. Of a tool that is a "
                   "mesh: of the balls at its points; 0: as baked")
        ->check(CLI::Range(0.0, 50.0));
    app.add_option("--stiffness", o.surface.stiffness_n_m, "of a surface, N/m")
        ->check(CLI::Range(1.0, 20000.0))
        ->capture_default_str();
    app.add_option("--friction", o.surface.friction, "coefficient of a surface")
        ->check(CLI::Range(0.0, 2.0))
        ->capture_default_str();
    app.add_option("--mode", v.surface_mode,
                   "how a surface is looked up: off-brute, off-tree or chr (fine around the tool)")
        ->check(CLI::IsMember({"off-brute", "off-tree", "chr"}));
    app.add_option("--seed", o.seed, "of that direction, and of the emulated hand");
    app.add_option("--force-scale", v.force_scale, "times the scene's own gain")->check(CLI::Range(0.0, 1e6));
    app.add_flag("--check", o.check, "read and check everything, then exit");
}

RtConfig configure(const StartOptions& o, const StartOverrides& v) {
    RtConfig c;
    if (!o.config.empty()) read_config(o.config, c);
    if (v.rate_hz) {
        c.servo.period_us = 1e6 / *v.rate_hz;
        c.servo.free_running = false;
    }
    if (v.free_run) c.servo.free_running = true;
    // A FIFO loop that never sleeps would be throttled, so free running is ordinary unless asked otherwise.
    if (c.servo.free_running && !v.priority) c.servo.priority = 0;
    if (v.priority) c.servo.priority = *v.priority;
    if (v.core) c.servo.core = *v.core;
    if (v.law) c.governor.law = *v.law;
    if (v.hand) c.device.hand = *v.hand;
    if (v.hand2) {
        if (c.device2.driver == "none") c.device2.driver = "sim";
        c.device2.hand = *v.hand2;
        if (*v.hand2 == "sucker") c.device2.hand_seed = static_cast<std::int64_t>(o.seed);
    }
    if (!v.hand_at_mm.empty()) c.device.hand_at_mm = {v.hand_at_mm[0], v.hand_at_mm[1]};
    if (v.pedal) c.drilling.pedal = *v.pedal;
    if (v.burr_mm) c.drilling.burr_diameter_mm = *v.burr_mm;
    if (v.burr_shape) c.drilling.burr_shape = *v.burr_shape;
    if (v.burr_rpm) c.drilling.burr_rpm = *v.burr_rpm;
    if (v.surface_mode) c.surface.mode = *v.surface_mode;
    if (v.goal_hz) c.governor.goal_hz = *v.goal_hz;
    if (v.picture_goal_hz) c.governor.picture_goal_hz = *v.picture_goal_hz;
    if (v.force_scale) c.shape.force_scale = *v.force_scale;
    if (!o.levels.empty()) c.governor.law = "fixed";
    c.device.hand_seed = static_cast<std::int64_t>(o.seed);
    check_config(c, "command line and configuration");
    return c;
}

}  // namespace tact
