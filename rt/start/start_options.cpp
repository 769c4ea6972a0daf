#include "rt/start/start_options.hpp"

#include <CLI/CLI.hpp>

#include "hal/sim/sim_hand.hpp"
#include "ipc/version/version.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

void describe(CLI::App& app, StartOptions& o, StartOverrides& v) {
    app.set_version_flag("--version", program_version("tact-rt"));
    auto* const scene = app.add_option("scene", o.scene, "Scene file written by tact-prep");
    auto* const check =
        app.add_option("--check-config", o.check_config,
                       "Configuration (TOML) to check without a scene and without a device; exits afterwards")
            ->type_name("FILE.toml")
            ->excludes(scene);
    app.add_flag("--json", o.json, "Print the result of --check-config as JSON, with the value of every key")
        ->needs(check);
    app.callback([&o] {
        if (o.scene.empty() && o.check_config.empty()) throw CLI::RequiredError("scene");
    });
    app.add_option("--session", o.session,
                   "Session name by which the other programs find this one; default: default")
        ->type_name("NAME");
    app.add_option("--config", o.config,
                   "Configuration (TOML); deploy/tact.toml (/etc/tact/tact.toml) lists every key")
        ->type_name("FILE.toml");
    app.add_option("--seconds", o.seconds, "Length of the run (s); 0: until a signal")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e7));
    auto* rate = app.add_option("--rate", v.rate_hz, "Servo rate (Hz)")
                     ->type_name("HZ")
                     ->check(CLI::Range(10.0, 20000.0));
    app.add_flag("--free-run", v.free_run, "Update the force as often as the processor allows")
        ->excludes(rate);
    app.add_option("--law", v.law, "Law of the governor, which trades accuracy for rate")
        ->type_name("elastic|sensitus|fixed");
    app.add_option("--goal", v.goal_hz, "Force rate that the governor holds (Hz)")
        ->type_name("HZ")
        ->check(CLI::Range(1.0, 1e7));
    app.add_option("--display-goal", v.display_goal_hz,
                   "Frame rate below which the governor draws a coarser surface (frames/s); 0: none")
        ->type_name("FPS")
        ->check(CLI::Range(0.0, 1000.0));
    app.add_flag("--arm", o.arm, "Arm at once instead of waiting for a command");
    app.add_flag("--arm-with-gui", o.arm_with_gui, "Arm once the window has drawn its first frame");
    app.add_option("--level", o.levels,
                   "Fixed level of one path, from 0 to 1, such as docking.force=1; sets the law to fixed")
        ->type_name("PATH=VALUE");
    app.add_option("--core", v.core,
                   "Processor core of the servo thread; -1: chosen automatically; -2: not pinned");
    app.add_option("--priority", v.priority, "FIFO priority of the servo thread; 0: ordinary scheduling")
        ->check(CLI::Range(0, 94));
    auto* offset = app.add_option("--start-offset-a", o.start_offset_a,
                                  "Start distance of the first body from its pose in the scene (angstrom)")
                       ->check(CLI::Range(0.0, 1e4));
    auto* rotation = app.add_option("--start-rotation-deg", o.start_rotation_deg,
                                    "Start rotation of the first body from its pose in the scene (degrees)")
                         ->check(CLI::Range(0.0, 180.0));
    auto* copies =
        app.add_option("--copies", o.copies,
                       "Number of bodies of the first structure; the copies are placed around the map")
            ->check(CLI::Range(1, static_cast<int>(ModelBodies::kMax)));
    app.add_option("--poses", o.poses, "Start poses of the bodies, from the report of an earlier run (JSON)")
        ->type_name("FILE.json")
        ->excludes(offset)
        ->excludes(rotation)
        ->excludes(copies);
    auto* const resume =
        app.add_option("--resume", o.resume,
                       "Start with the bone as it was drilled in an earlier run, which kept it in this file")
            ->type_name("FILE.bone");
    // Of a recorded run: its replay needs the file as it was.
    app.add_option("--resume-identity", o.resume_identity)->needs(resume)->group("");
    app.add_option(
           "--flexible", o.flexible,
           "on: the body in the hand bends along the normal modes of its structure; the scene must be "
           "baked with --modes")
        ->check(CLI::IsMember({"on", "off"}))
        ->capture_default_str();
    app.add_option(
           "--hand", v.hand,
           "Motion of the emulated hand; mouse, spacemouse, gamepad: led by that device in the window")
        ->type_name("passive|wander|stroke|drill|surgeon|suction-tube|mouse|spacemouse|gamepad");
    app.add_flag("--mouse", v.mouse,
                 "The mouse in the window may take an emulated hand from its motion, and then leads it");
    app.add_option("--hand2", v.hand2,
                   "Motion of a second, emulated hand, if the configuration has none; suction-tube: "
                   "accompanies the surgeon")
        ->type_name("passive|wander|stroke|drill|surgeon|suction-tube|mouse|spacemouse|gamepad");
    app.add_option("--hand-at-mm", v.hand_at_mm, "Position at which an emulated surgeon works (mm)")
        ->delimiter(',')
        ->expected(2);
    app.add_option("--pedal", v.pedal,
                   "Switch of the burr: stylus button, foot pedal on an input line, or always on")
        ->type_name("button|line|always");
    app.add_option("--burr-mm", v.burr_mm, "Burr diameter (mm)")->type_name("MM");
    app.add_option("--burr-shape", v.burr_shape, "Burr shape")->type_name("sphere|cylinder|cone");
    app.add_option("--burr-grit", v.burr_grit, "Burr with flutes or with grains of diamond")
        ->type_name("cutting|diamond");
    app.add_option("--burr-rpm", v.burr_rpm, "Burr speed (rpm)")->type_name("RPM");
    app.add_option("--tool-radius-mm", o.tool_radius_mm,
                   "Radius of the ball that touches a surface (mm in the workspace); 0: a point. For a mesh "
                   "as the tool: radius of the balls at the contact points; 0: as baked")
        ->type_name("MM")
        ->check(CLI::Range(0.0, 50.0));
    app.add_option("--stiffness", o.surface.stiffness_n_m, "Stiffness of the surface (N/m)")
        ->type_name("N/M")
        ->check(CLI::Range(1.0, 20000.0))
        ->capture_default_str();
    app.add_option("--friction", o.surface.friction,
                   "Friction coefficient of the surface, before the tool slides")
        ->check(CLI::Range(0.0, 2.0))
        ->capture_default_str();
    app.add_option("--dynamic-friction", o.surface.dynamic_friction,
                   "Friction coefficient while the tool slides, at most that of --friction; default: equal")
        ->type_name("MU")
        ->check(CLI::Range(0.0, 2.0));
    app.add_option(
           "--mode", v.surface_mode,
           "Contact search on the surface; chr: refined around the tool, which saves the servo no time")
        ->check(CLI::IsMember({"off-brute", "off-tree", "chr"}));
    app.add_option("--seed", o.seed, "Random seed for the start direction and the emulated hand");
    app.add_option("--force-scale", v.force_scale, "Factor on the force gain of the scene")
        ->check(CLI::Range(0.0, 1e6));
    app.add_flag("--check", o.check, "Read and check scene and configuration, then exit");
}

RtConfig configure(const StartOptions& o, const StartOverrides& v) {
    RtConfig c;
    if (!o.config.empty()) read_config(o.config, c);
    if (v.rate_hz) {
        c.servo.period_us = 1e6 / *v.rate_hz;
        c.servo.free_running = false;
    }
    if (v.free_run) c.servo.free_running = true;
    // The kernel throttles a FIFO loop that never sleeps, so free running uses ordinary scheduling by default.
    if (c.servo.free_running && !v.priority) c.servo.priority = 0;
    if (v.priority) c.servo.priority = *v.priority;
    if (v.core) c.servo.core = *v.core;
    if (v.law) c.governor.law = *v.law;
    if (v.hand) c.device.hand = current_hand_name(*v.hand);
    if (v.mouse) c.device.mouse = true;
    if (v.hand2) {
        if (c.device2.driver == "none") c.device2.driver = "sim";
        c.device2.hand = current_hand_name(*v.hand2);
        if (c.device2.hand == "suction-tube") c.device2.hand_seed = static_cast<std::int64_t>(o.seed);
    }
    if (!v.hand_at_mm.empty()) c.device.hand_at_mm = {v.hand_at_mm[0], v.hand_at_mm[1]};
    if (v.pedal) c.drilling.pedal = *v.pedal;
    if (v.burr_mm) c.drilling.burr_diameter_mm = *v.burr_mm;
    if (v.burr_shape) c.drilling.burr_shape = *v.burr_shape;
    if (v.burr_grit) c.drilling.burr_grit = *v.burr_grit;
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
