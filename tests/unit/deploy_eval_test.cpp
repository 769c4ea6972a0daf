// tact eval: a file of poses, hostile or not, and the resulting forces.
#include "deploy/tact/docking/eval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "deploy/tact/docking/poses_csv.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "tests/bench/bench_docking.hpp"

namespace tact::launch::deploy_eval_test {
namespace {

constexpr char kHeader[] = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n";

std::vector<TimedPose> read(const std::string& text) {
    std::istringstream in(text);
    return read_poses_csv(in, "poses.csv");
}

std::string error_of(const std::string& text) {
    try {
        (void)read(text);
    } catch (const StartupError& e) {
        return e.what();
    }
    return "";
}

TEST(PosesCsv, reads_valid_rows) {
    const auto poses = read(std::string("\xEF\xBB\xBF# made by hand\r\n") + kHeader +
                            "0,1,2,3,0,0,0,1\r\n\n 0.5, -1e-3 ,0,0, 0.6,0,0,0.8\n# end\n1,0,0,0,0,0,1.05,0");
    ASSERT_EQ(poses.size(), 3U);
    EXPECT_EQ(poses[0].T_world_tool.p_m, Vec3(1, 2, 3));
    EXPECT_EQ(poses[1].t_s, 0.5);
    EXPECT_NEAR(poses[1].T_world_tool.q.w(), 0.8, 1e-15);
    EXPECT_NEAR(poses[1].T_world_tool.q.x(), 0.6, 1e-15);
    EXPECT_NEAR(poses[2].T_world_tool.q.z(), 1.0, 1e-15);  // normalized
}

TEST(PosesCsv, names_the_invalid_line) {
    const std::string good = "0,0,0,0,0,0,0,1\n";
    for (const char* bad :
         {"0,0,0,0,0,0,1", "0,0,0,0,0,0,0,1,2", "0,0,x,0,0,0,0,1", "0,0,nan,0,0,0,0,1", "0,0,inf,0,0,0,0,1",
          "0,0,1e999,0,0,0,0,1", "0,0,0x10,0,0,0,0,1", "0,0,,0,0,0,0,1", "0,0,0,0,0,0,0,0", "0,0,0,0,9,0,0,1",
          "\x01\x02\xff", "0 0 0 0 0 0 0 1", ",,,,,,,"}) {
        const std::string error = error_of(kHeader + good + good + bad + "\n" + good);
        EXPECT_NE(error.find("line 4"), std::string::npos) << bad << ": " << error;
    }
    EXPECT_NE(error_of(kHeader + good + std::string(100000, '1')).find("line 3"), std::string::npos);
    EXPECT_NE(error_of(good).find("header"), std::string::npos);
    EXPECT_NE(error_of("").find("no poses"), std::string::npos);
    EXPECT_NE(error_of(kHeader).find("no poses"), std::string::npos);
    EXPECT_NE(error_of(std::string(5000, '\0')).find("line 1"), std::string::npos);
    EXPECT_THROW((void)read_poses_csv("/nonexistent/poses.csv"), StartupError);
    EXPECT_THROW((void)read_poses_csv("/"), StartupError);
}

// A Gaussian blob and a body of four atoms.
void write_scene(const std::filesystem::path& path, std::uint32_t bodies = 1) {
    SceneMeta meta{};
    meta.kind = SceneKind::docking;
    meta.body_count = bodies;
    meta.world_per_model = 1e7;
    for (double& c : meta.centre_model_m) c = 30e-10;
    meta.energy_j_per_sigma = 0.02;
    meta.map_mean = 0.0;
    meta.map_sigma = 0.5;
    meta.contour = 0.2;
    meta.resolution_m = 10e-10;
    DensityGrid grid;
    grid.size = {20, 20, 20};
    grid.spacing_m = Vec3::Constant(3e-10);
    grid.values.resize(grid.count());
    for (std::uint32_t z = 0; z < 20; ++z) {
        for (std::uint32_t y = 0; y < 20; ++y) {
            for (std::uint32_t x = 0; x < 20; ++x) {
                const double d2 = (Vec3(x, y, z) - Vec3(10, 10, 10)).squaredNorm();
                grid.values[(std::size_t{z} * 20 + y) * 20 + x] = static_cast<float>(std::exp(-d2 / 18.0));
            }
        }
    }
    Structure body;
    body.name = "cross";
    body.home_com_model_m = Vec3::Constant(30e-10);
    body.mass_u = 48.0;
    body.x_m = {5e-10F, -5e-10F, 0.0F, 0.0F};
    body.y_m = {0.0F, 0.0F, 5e-10F, -5e-10F};
    body.z_m = {0.0F, 0.0F, 0.0F, 0.0F};
    body.mass_fraction = {0.25F, 0.25F, 0.25F, 0.25F};
    body.element = {6, 6, 6, 6};
    body.chain = {0, 0, 0, 0};
    body.residue = {1, 2, 3, 4};
    body.trace = {1, 1, 1, 1};
    body.chain_names = {"A"};
    SceneWriter out;
    write_meta(out, meta, "test: yes");
    write_grid(out, grid);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        write_structure(out, i, body);
        write_codebook(out, i, Codebook{});
        body.name = "beside";
        body.home_com_model_m.x() += 8e-10;
        for (float& y : body.y_m) y *= 1.5F;
    }
    out.write(path);
}

std::vector<std::vector<std::string>> rows(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::vector<std::vector<std::string>> out;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        out.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) out.back().push_back(field);
    }
    return out;
}

TEST(Eval, writes_the_force_of_the_servos_model_for_every_pose) {
    const ScratchFolder folder;
    const auto scene = folder.path() / "scene.tact", poses = folder.path() / "in.csv",
               out = folder.path() / "out.csv";
    write_scene(scene);
    std::ofstream(poses)
        << kHeader << "0,0,0,0,0,0,0,1\n0.1,0.01,0,0,0,0,0,1\n0.2,0.01,-0.004,0.003,0.1,0.2,0.3,0.927\n";
    const EvalSummary summary = run_eval({scene, poses, out, 1.0});
    EXPECT_EQ(summary.poses, 3U);
    EXPECT_EQ(summary.not_ok, 0U);
    const auto table = rows(out);
    ASSERT_EQ(table.size(), 4U);
    EXPECT_EQ(table[0].size(), 11U);
    EXPECT_EQ(table[0].back(), "status");
    // In the centre of the blob there is no force; to its right the force points left.
    EXPECT_LT(std::abs(std::stod(table[1][1])), 1e-3);
    EXPECT_LT(std::stod(table[2][1]), -0.05);
    EXPECT_EQ(table[3].back(), "ok");
    // The same numbers as the servo's model, at the body's pose in its grip.
    const auto model = load_docking_model(SceneFile::open(scene), {});
    const auto given = read_poses_csv(poses);
    for (std::size_t i = 0; i < given.size(); ++i) {
        const Pose body{model->meta().to_model(given[i].T_world_tool.p_m), given[i].T_world_tool.q};
        const Wrench w = model->evaluate(body, Budget{}).wrench_world;
        for (int a = 0; a < 3; ++a) {
            const auto column = static_cast<std::size_t>(a);
            EXPECT_NEAR(std::stod(table[i + 1][1 + column]), w.force_n[a],
                        1e-8 * (1.0 + std::abs(w.force_n[a])));
            EXPECT_NEAR(std::stod(table[i + 1][4 + column]), w.torque_n_m[a], 1e-8);
        }
    }
}

// Each option and each body, against a model that is set up by orders.
TEST(Eval, takes_every_body_and_option) {
    const ScratchFolder folder;
    const auto scene = folder.path() / "scene.tact", poses = folder.path() / "in.csv",
               out = folder.path() / "out.csv";
    write_scene(scene, 2);
    std::ofstream(poses) << kHeader << "0,0.006,0.001,0,0.1,0.2,0.3,0.927\n";
    const std::vector<TimedPose> given = read_poses_csv(poses);
    std::vector<double> seen;
    for (const std::uint32_t id : {1U, 2U})
        for (const std::uint32_t options :
             {0U, static_cast<std::uint32_t>(kDockingClash), static_cast<std::uint32_t>(kDockingSubtraction),
              static_cast<std::uint32_t>(kDockingLaplacian)}) {
            EXPECT_EQ(run_eval({scene, poses, out, 1.0, id, options}).not_ok, 0U);
            const double force_n = std::stod(rows(out)[1][1]);
            for (const double other : seen)
                EXPECT_GT(std::abs(force_n - other), 1e-6) << id << " " << options;
            seen.push_back(force_n);
            auto model = load_docking_model(SceneFile::open(scene), {});
            ModelOrder select;
            select.body = id;
            ASSERT_TRUE(model->order(select));
            EXPECT_TRUE(options == 0 || model->set_options(options, true));
            const auto made = model->rebuild(model->bodies());
            ASSERT_TRUE(made->adopt(*model));
            const Pose body{model->meta().to_model(given[0].T_world_tool.p_m), given[0].T_world_tool.q};
            const double expected_n =
                dynamic_cast<DockingModel&>(*made).evaluate(body, Budget{}).wrench_world.force_n.x();
            EXPECT_NEAR(force_n, expected_n, 1e-8 * (1.0 + std::abs(expected_n)));
        }
    EXPECT_THROW(run_eval({scene, poses, out, 1.0, 3}), StartupError);
    EXPECT_THROW(run_eval({scene, poses, out, 1.0, 0}), StartupError);
}

TEST(Eval, fails_with_a_message_and_leaves_no_partial_file) {
    const ScratchFolder folder;
    const auto scene = folder.path() / "scene.tact", poses = folder.path() / "in.csv",
               out = folder.path() / "out.csv";
    write_scene(scene);
    std::ofstream(poses) << kHeader << "0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,what\n";
    EXPECT_THROW(run_eval({scene, poses, out, 1.0}), StartupError);
    std::ofstream(poses) << kHeader << "0,0,0,0,0,0,0,1\n";
    EXPECT_THROW(run_eval({folder.path() / "none.tact", poses, out, 1.0}), StartupError);
    EXPECT_THROW(run_eval({scene, poses, out, 1.5}), StartupError);
    EXPECT_THROW(run_eval({scene, poses, out, std::nan("")}), StartupError);
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(BenchDocking, measures_positive_times) {
    const DockingBench bench = bench_docking({.steps = 50, .stretch_n200 = 20, .stretch_atoms100k = 2});
    EXPECT_GT(bench.force_us_n200.p50, 0.0);
    EXPECT_GT(bench.force_us_atoms100k.p50, bench.force_us_n200.p50);
    EXPECT_GE(bench.force_us_atoms100k.p99, bench.force_us_atoms100k.p50);
    EXPECT_GE(bench.force_us_atoms100k.max, bench.force_us_atoms100k.p999);
    EXPECT_GT(bench.force_us_atoms100k_best_of_20, bench.force_us_n200_best_of_20);
    EXPECT_GT(bench.force_us_n200_best_of_20, 0.0);
    EXPECT_FALSE(bench.kernel.empty());
    EXPECT_GT(bench.map_bytes, 128U * 128U * 128U * 4U);
}

}  // namespace
}  // namespace tact::launch::deploy_eval_test
