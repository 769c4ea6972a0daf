// --save: the bodies placed by the hand are saved at the end of a run, or the failure is reported.
#include "deploy/tact/docking/save_fit.hpp"

#include <cmath>
#include <fstream>

#include "tests/unit/deploy_run_stand_ins.hpp"

namespace tact::launch {
namespace {

// A scene that names the files of its structures.
void write_scene_of_files(const std::filesystem::path& path) {
    sample::scene(sample::meta(), sample::structure(), sample::codebook(), sample::grid(),
                  "map: sample\nstructure: /a.pdb\nstructure check: 1 bytes, crc32 00000000\n")
        .write(path);
}

TEST(PosesJson, a_bent_body_has_the_amplitudes_of_its_modes) {
    BodiesTopic bodies{};
    bodies.count = 2;
    for (std::uint32_t i = 0; i < 2; ++i) {
        bodies.body[i].id = i + 1;
        bodies.body[i].quat_model_body_xyzw[3] = 1.0;
    }
    ShapesTopic shapes{};
    shapes.body[0].id = 2;
    shapes.body[0].amplitude_m[1] = -3e-10F;
    const std::vector<Structure> structures{sample::structure()};
    const nlohmann::json list = poses_json(bodies, &shapes, structures).at("bodies");
    EXPECT_FALSE(list[0].contains("mode_amplitudes_a"));
    ASSERT_EQ(list[1].at("mode_amplitudes_a").size(), 2U);
    EXPECT_NEAR(list[1].at("mode_amplitudes_a")[1].get<double>(), -3.0, 1e-5);
    EXPECT_FALSE(poses_json(bodies, nullptr, structures).at("bodies")[1].contains("mode_amplitudes_a"));
}

TEST_F(DeployRun, at_the_end_tact_prep_saves_the_last_poses) {
    write_scene_of_files(scene_);
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    ASSERT_EQ(error_once_seen(), "");
    const auto poses = nlohmann::json::parse(read_small(options_.save / "poses.json"))["bodies"];
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(poses[0]["id"], 6);
    EXPECT_EQ(poses[0]["structure"], 0);
    EXPECT_EQ(poses[0]["name"], sample::structure().name);
    const Vec3 home_a = sample::structure().home_com_model_m * 1e10;
    EXPECT_NEAR(poses[0]["pos_model_a"][0].get<double>(), home_a.x() + 3.0, 1e-9);
    EXPECT_NEAR(poses[0]["pos_model_a"][2].get<double>(), home_a.z(), 1e-9);
    EXPECT_NEAR(poses[0]["quat_model_body_xyzw"][2].get<double>(), std::sqrt(0.5), 1e-12);
    EXPECT_EQ(read_small(options_.save / "asked.txt"), "export\n" + scene_.string() + "\n--poses\n" +
                                                           (options_.save / "poses.json").string() +
                                                           "\n-o\n" + options_.save.string() + "\n");
}

TEST_F(DeployRun, an_impossible_save_is_refused_before_the_run) {
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("is synthetic"), std::string::npos);
    write_scene_of_files(scene_);
    std::filesystem::create_directory(options_.save);
    std::ofstream(options_.save / "mine") << "x";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("never overwritten"),
              std::string::npos);
    options_.save = options_.save / "mine";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("not a folder"), std::string::npos);
}

TEST_F(DeployRun, a_failed_save_is_reported_and_keeps_the_poses) {
    misbehave("prep");
    write_scene_of_files(scene_);
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    const std::string error = error_once_seen();
    EXPECT_NE(error.find("exit code 5"), std::string::npos) << error;
    EXPECT_TRUE(std::filesystem::exists(options_.save / "poses.json"));
}

TEST_F(DeployRun, a_save_can_be_interrupted_and_keeps_the_poses) {
    misbehave("prep-interrupted");
    write_scene_of_files(scene_);
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    const std::string error = error_once_seen();
    EXPECT_NE(error.find("ended by Interrupt"), std::string::npos) << error;
    EXPECT_TRUE(std::filesystem::exists(options_.save / "poses.json"));
}

}  // namespace
}  // namespace tact::launch

int main(int argc, char** argv) { return tact::launch::play(argc, argv); }
