// tact eval: computes the servo's docking force at poses from a file, for comparison with other programs.
#include <memory>

#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/docking/eval.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact::launch {

namespace {

int eval(const EvalRequest& o) {
    const EvalSummary s = run_eval(o);
    std::printf(
        "%llu poses, %llu with errors; largest force %.3f N; time per step %.2f us (median), %.2f us "
        "(maximum)\nwrote %s\n",
        static_cast<unsigned long long>(s.poses), static_cast<unsigned long long>(s.not_ok), s.force_n_max,
        s.cost_us_p50, s.cost_us_max, o.out_csv.c_str());
    return 0;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "eval",
        "Compute the docking force and torque at poses from a CSV file (t_s,x_m,y_m,z_m,qx,qy,qz,qw)");
    const auto o = std::make_shared<EvalRequest>();
    command->add_option("SCENE", o->scene, "Docking scene written by tact-prep")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_option("--poses", o->poses_csv, "Poses of the tool in the world frame (CSV)")
        ->required()
        ->type_name("IN.csv")
        ->check(CLI::ExistingFile);
    command
        ->add_option("--out", o->out_csv,
                     "Forces (N), torques (N m) and computing times to write, one line per pose (CSV)")
        ->required()
        ->type_name("OUT.csv");
    command
        ->add_option("--fidelity", o->fidelity,
                     "Fidelity of the force; 1: all atoms; 0: the smallest codebook")
        ->type_name("F")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command
        ->add_option("--body", o->body,
                     "Body at the poses, counted from 1; the others stay at the positions in their files")
        ->type_name("N")
        ->capture_default_str();
    const auto option = [&](const char* name, std::uint32_t bit, const char* help) {
        command->add_flag_callback(
            name, [o, bit] { o->options |= bit; }, help);
    };
    option("--clash", kDockingClash, "Add the force by which the other bodies repel it");
    option("--subtract", kDockingSubtraction, "Without the density that the other bodies explain");
    option("--laplacian", kDockingLaplacian, "Force from the Laplacian of the map");
    command->callback([o, &exit_code] { exit_code = eval(*o); });
}

}  // namespace tact::launch
