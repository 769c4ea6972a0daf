// Poses of bodies in files written by programs and people: valid and refused input.
#include "prep/export/poses_file.hpp"

#include <gtest/gtest.h>

#include "tests/unit/scene_samples.hpp"

namespace tact::prep_poses_file_test {
namespace {

using sample::error_of;

TEST(PosesFile, reads_the_file_of_a_run_and_ignores_other_keys) {
    const auto bodies = read_poses(
        R"({"seconds": 3, "bodies": [{"id": 4, "structure": 1, "name": "x", "flags": 1, "pos_model_a": [1, -2.5, 3],
            "quat_model_body_xyzw": [0, 0, 1, 0]}]})",
        "run.json", 2);
    ASSERT_EQ(bodies.size(), 1U);
    EXPECT_EQ(bodies[0].id, 4U);
    EXPECT_EQ(bodies[0].structure, 1U);
    EXPECT_NEAR(bodies[0].T_model_body.p_m.y(), -2.5e-10, 1e-20);
    EXPECT_EQ(bodies[0].T_model_body.q.z(), 1.0);
}

TEST(PosesFile, invalid_input_is_refused) {
    const auto refused = [](const std::string& text) {
        return !error_of([&] { read_poses(text, "x", 2); }).empty();
    };
    const std::string good =
        R"({"id":1,"structure":0,"pos_model_a":[0,0,0],"quat_model_body_xyzw":[0,0,0,1]})";
    const auto list = [](const std::string& body) { return "{\"bodies\":[" + body + "]}"; };
    EXPECT_FALSE(refused(list(good)));
    EXPECT_TRUE(refused(list(good + "," + good)));  // duplicate id
    for (const char* bad :
         {"", "[]", "{}", "{\"bodies\":3}", "{\"bodies\":[]}", "{\"bodies\":[3]}", "nonsense"})
        EXPECT_TRUE(refused(bad)) << bad;
    const std::pair<const char*, const char*> changes[] = {{"\"id\":1", "\"id\":-1"},
                                                           {"\"id\":1", "\"id\":1.5"},
                                                           {"\"id\":1", "\"id\":1e300"},
                                                           {"\"id\":1", "\"id\":\"1\""},
                                                           {"\"structure\":0", "\"structure\":2"},
                                                           {"\"structure\":0", "\"other\":0"},
                                                           {"[0,0,0]", "[0,0]"},
                                                           {"[0,0,0]", "[0,0,\"a\"]"},
                                                           {"[0,0,0]", "[0,0,1e9]"},
                                                           {"[0,0,0]", "[0,0,1e400]"},
                                                           {"[0,0,0,1]", "[0,0,0,0]"},
                                                           {"[0,0,0,1]", "[0,0,0,2]"},
                                                           {"[0,0,0,1]", "[0,0,0,null]"}};
    for (const auto& [from, to] : changes) {
        std::string body = good;
        body.replace(body.find(from), std::string(from).size(), to);
        EXPECT_TRUE(refused(list(body))) << body;
    }
}

}  // namespace
}  // namespace tact::prep_poses_file_test
