#include "rt/start/start_options.hpp"

#include <CLI/CLI.hpp>

#include "hal/sim/sim_hand.hpp"
#include "ipc/version/version.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

void describe(CLI::App& app, StartOptions& o, StartOverrides& v) {
    app.set_version_flag("--version", program_version("tact-rt"));
    auto* const scene = app.add_option("scene", o.scene, "baked scene, from tact-prep");
    auto* const check =
        app.add_option("--check-config", o.check_config,
                       "check this configuration without a scene and without a device, then exit")
            ->type_name("FILE.toml")
            ->excludes(scene);
    app.add_flag("--json", o.json, "with --check-config: as JSON, with the value of every key")->needs(check);
    app.callback([&o] {
        if (o.scene.empty() && o.check_config.empty()) throw CLI::RequiredError("scene");
    });
    app.add_option("--session", o.session, "name under which the other programs find this one")
        ->type_name("NAME");
    app.add_option("--config", o.config, "TOML file; deploy/tact.toml (/etc/tact/tact.toml) shows every key")
        ->type_name("FILE.toml");
    app.add_option("--seconds", o.seconds, "end after this time; 0: run until a signal")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    auto* rate =
        app.add_option("--rate", v.rate_hz, "servo rate")->type_name("HZ")->check(CLI::Range(10.0, 20000.0));
    app.add_flag("--free-run", v.free_run, "as many updates as the processor gives")->excludes(rate);
    app.add_option("--law", v.law, "law of the governor")->type_name("elastic|sensitus|fixed");
    app.add_option("--goal", v.goal_hz, "force rate that the governor holds")
        ->type_name("HZ")
        ->check(CLI::Range(1.0, 1e7));
    app.add_option("--picture-goal", v.display_goal_hz,
                   "frames a second below which the surface gets coarser; 0: none")
        ->type_name("FPS")
        ->check(CLI::Range(0.0, 1000.0));
    app.add_flag("--arm", o.arm, "arm at once instead of waiting for a command");
    app.add_flag(
        "--arm-with-gui", o.arm_with_gui,
        "arm once, when the visual process has drawn its first frame, so that a person sees all of it");
    app.add_option("--level", o.levels, "fixed level of a path, e.g. docking.force=1; the law becomes fixed")
        ->type_name("PATH=VALUE");
    app.add_option("--core", v.core, "core of the servo thread; -1: chosen, -2: not pinned");
    app.add_option("--priority", v.priority, "FIFO priority of the servo thread; 0: ordinary scheduling")
        ->check(CLI::Range(0, 94));
    auto* offset = app.add_option("--start-offset-a", o.start_offset_a,
                                  "the first body starts so many angstroms from home")
                       ->check(CLI::Range(0.0, 1e4));
    auto* rotation = app.add_option("--start-rotation-deg", o.start_rotation_deg,
                                    "the first body starts turned by so many degrees from home")
                         ->check(CLI::Range(0.0, 180.0));
    auto* copies =
        app.add_option(
               "--copies", o.copies,
               "so many bodies of the first structure; those behind the first stand free about the map")
            ->check(CLI::Range(1, static_cast<int>(ModelBodies::kMax)));
    app.add_option("--poses", o.poses,
                   "start with the bodies in this JSON file, as the report of a run lists them")
        ->type_name("FILE.json")
        ->excludes(offset)
        ->excludes(rotation)
        ->excludes(copies);
    app.add_option("--hand", v.hand, "motion of the hand of the emulated device")
        ->type_name("passive|wander|stroke|drill|surgeon|suction-tube");
    app.add_option(
           "--hand2", v.hand2,
           "a second hand, emulated too, where the configuration has none; suction-tube: goes with the "
           "surgeon in the first")
        ->type_name("passive|wander|stroke|drill|surgeon|suction-tube");
    app.add_option("--hand-at-mm", v.hand_at_mm, "position in mm at which an emulated surgeon works")
        ->delimiter(',')
        ->expected(2);
    app.add_option("--pedal", v.pedal,
                   "switch of the burr: button (of the stylus), line (a foot pedal) or always")
        ->type_name("button|line|always");
    app.add_option("--burr-mm", v.burr_mm, "diameter of the burr")->type_name("MM");
    app.add_option("--burr-shape", v.burr_shape, "shape of the burr")->type_name("sphere|cylinder|cone");
    app.add_option("--burr-rpm", v.burr_rpm, "speed of the burr")->type_name("RPM");
    app.add_option(
           "--tool-radius-mm", o.tool_radius_mm,
           "radius of the ball that touches a surface, in the hand's space; 0: a point. With a mesh as "
           "the tool: radius of the balls at its points; 0: as baked")
        ->type_name("MM")
        ->check(CLI::Range(0.0, 50.0));
    app.add_option("--stiffness", o.surface.stiffness_n_m, "stiffness of a surface")
        ->type_name("N/M")
        ->check(CLI::Range(1.0, 20000.0))
        ->capture_default_str();
    app.add_option("--friction", o.surface.friction, "friction coefficient of a surface")
        ->check(CLI::Range(0.0, 2.0))
        ->capture_default_str();
    app.add_option("--mode", v.surface_mode,
                   "how a surface is looked up: off-brute, off-tree or chr (fine around the tool)")
        ->check(CLI::IsMember({"off-brute", "off-tree", "chr"}));
    app.add_option("--seed", o.seed, "random seed of the start direction and of the emulated hand");
    app.add_option("--force-scale", v.force_scale, "factor of the scene's own gain")
        ->check(CLI::Range(0.0, 1e6));
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
    if (v.hand) c.device.hand = current_hand_name(*v.hand);
    if (v.hand2) {
        if (c.device2.driver == "none") c.device2.driver = "sim";
        c.device2.hand = current_hand_name(*v.hand2);
        if (c.device2.hand == "suction-tube") c.device2.hand_seed = static_cast<std::int64_t>(o.seed);
    }
    if (!v.hand_at_mm.empty()) c.device.hand_at_mm = {v.hand_at_mm[0], v.hand_at_mm[1]};
    if (v.pedal) c.drilling.pedal = *v.pedal;
    if (v.burr_mm) c.drilling.burr_diameter_mm = *v.burr_mm;
    if (v.burr_shape) c.drilling.burr_shape = *v.burr_shape;
    if (v.burr_rpm) c.drilling.burr_rpm = *v.burr_rpm;
    if (v.surface_mode) c.surface.mode = *v.surface_mode;
    if (v.goal_hz) c.governor.goal_hz = *v.goal_hz;
    if (v.display_goal_hz) c.governor.display_goal_hz = *v.display_goal_hz;
    if (v.force_scale) c.shape.force_scale = *v.force_scale;
    if (!o.levels.empty()) c.governor.law = "fixed";
    c.device.hand_seed = static_cast<std::int64_t>(o.seed);
    check_config(c, "command line and configuration");
    return c;
}

}  // namespace tact
