// Start poses of the bodies: from the file of an earlier run, valid or malicious, and copies around the map.
#include "rt/start/start_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "ipc/base/error.hpp"

namespace tact::start_bodies_test {
namespace {

const std::vector<std::string> kNames{"1AKE.pdb", "2REC.pdb"};

std::vector<StartBody> parse(const std::string& text) { return parse_start_bodies(text, "run.json", kNames); }

std::string body(const std::string& more = "") {
    return R"({"structure": 1, "pos_model_a": [10, -20.5, 3e1], "quat_model_body_xyzw": [0, 0.6, 0, 0.8])" +
           more + "}";
}
std::string list(const std::string& bodies) { return R"({"seconds": 3.5, "bodies": [)" + bodies + "]}"; }

TEST(StartBodies, are_read_from_the_list_of_a_report) {
    const auto bodies =
        parse(list(body() + "," + body(R"(, "id": 7, "name": "2REC.pdb", "fixed": true, "in_hand": true)")));
    ASSERT_EQ(bodies.size(), 2U);
    EXPECT_EQ(bodies[0].structure, 1U);
    EXPECT_LT((bodies[0].T_model_body.p_m - 1e-10 * Vec3(10, -20.5, 30)).norm(), 1e-20);
    EXPECT_NEAR(bodies[0].T_model_body.q.y(), 0.6, 1e-12);
    EXPECT_NEAR(bodies[0].T_model_body.q.w(), 0.8, 1e-12);
    EXPECT_FALSE(bodies[0].fixed || bodies[0].in_hand);
    EXPECT_TRUE(bodies[1].fixed && bodies[1].in_hand);
}

TEST(StartBodies, invalid_files_are_refused_with_the_number_of_the_body) {
    for (const std::string& text : std::vector<std::string>{
             std::string(),
             std::string("{"),
             std::string("[]"),
             std::string("{}"),
             std::string(R"({"bodies": {}})"),
             list(""),
             list("3"),
             list("{}"),
             list(R"({"structure": 2, "pos_model_a": [0,0,0], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": -1, "pos_model_a": [0,0,0], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0,"1"], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0,null], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0,1e300], "quat_model_body_xyzw": [0,0,0,1]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0,0], "quat_model_body_xyzw": [0,0,0,0]})"),
             list(R"({"structure": 0, "pos_model_a": [0,0,0], "quat_model_body_xyzw": [1,1,1,1]})"),
             list(body(R"(, "fixed": 1)")),
             list(body(R"(, "name": "1AKE.pdb")")),
         })
        EXPECT_THROW(parse(text), StartupError) << text;
    std::string many = body();
    for (int i = 0; i < 16; ++i) many.append(",").append(body());
    EXPECT_THROW(parse(list(many)), StartupError);
    try {
        parse(list(body() + ",{}"));
        FAIL();
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("body 2"), std::string::npos) << e.what();
    }
    EXPECT_THROW(read_start_bodies("/nonexistent/run.json", kNames), StartupError);
    EXPECT_THROW(read_start_bodies("/", kNames), StartupError);
}

TEST(StartBodies, a_damaged_file_is_refused_or_gives_valid_poses) {
    const std::string good = list(body() + "," + body());
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
        std::string text = good;
        for (int k = 0; k < 2; ++k) text[random() % text.size()] = static_cast<char>(random());
        try {
            for (const StartBody& b : parse(text)) {
                ASSERT_LT(b.structure, kNames.size());
                ASSERT_TRUE(b.T_model_body.finite());
                ASSERT_NEAR(b.T_model_body.q.norm(), 1.0, 1e-9);
            }
        } catch (const StartupError&) {
        }
    }
}

TEST(StartBodies, copies_are_placed_outside_the_map_and_apart) {
    DensityGrid grid;
    grid.size = {41, 21, 31};
    grid.spacing_m = Vec3::Constant(1e-10);
    grid.origin_m = Vec3(5e-10, 0.0, -3e-10);
    const auto bodies = copies_about(grid, 6);
    ASSERT_EQ(bodies.size(), 5U);
    const Vec3 middle = grid.origin_m + 1e-10 * Vec3(20, 10, 15);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        EXPECT_NEAR((bodies[i].T_model_body.p_m - middle).norm(), 24e-10, 1e-13);
        EXPECT_FALSE(bodies[i].fixed);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GT((bodies[i].T_model_body.p_m - bodies[k].T_model_body.p_m).norm(), 20e-10);
    }
    EXPECT_TRUE(copies_about(grid, 1).empty());
}

}  // namespace
}  // namespace tact::start_bodies_test
