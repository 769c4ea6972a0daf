// Places found for the window by tact-search and tact-refine, on the synthetic ring with one subunit free.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <thread>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/place_finder.hpp"
#include "gui/docking/placement_job.hpp"
#include "gui/docking/poses_json.hpp"
#include "gui/window/load_scene.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/structure.hpp"
#include "prep/synthetic/ring.hpp"
#include "tests/support/error_of.hpp"

namespace tact::gui_placement_test {
namespace {

class Placement : public testing::Test {
protected:
    static void SetUpTestSuite() {
        char name[] = "/tmp/tact-placement-test-XXXXXX";
        folder_ = mkdtemp(name);
        std::string bake = "'";  // the checkout's path may have spaces
        bake.append(TACT_PREP)
            .append("' demo dock -o '")
            .append(folder_)
            .append("/ring.tact' > /dev/null 2>&1");
        ASSERT_EQ(std::system(bake.c_str()), 0);
        content_ = load_scene(folder_ + "/ring.tact");
    }
    static void TearDownTestSuite() {
        content_.reset();
        std::filesystem::remove_all(folder_);
    }
    static const Structure& structure() { return docking_of(*content_).bodies[0]; }
    static PlacementOutcome result(PlacementJob& job, const PlacementRequest& request) {
        job.start(request);
        EXPECT_TRUE(job.running());
        for (int i = 0; i < 60'000; ++i) {
            if (std::optional<PlacementOutcome> done = job.poll()) return *done;
            EXPECT_GE(job.progress(), 0.0);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ADD_FAILURE() << "timed out";
        return {};
    }
    static bool too_slow_here() {
#ifdef TACT_SANITIZED
        return true;  // a search takes minutes
#else
        return false;
#endif
    }
    // From the nearest of the six places of a subunit.
    static double away_a(const Pose& place) {
        double nearest_m = 1.0;
        for (int turns = 0; turns < 6; ++turns) {
            const Quat turn(Eigen::AngleAxisd(turns * std::numbers::pi / 3.0, Vec3::UnitZ()));
            double farthest_m = 0.0;
            for (std::size_t i = 0; i < structure().size(); i += 20) {
                const Vec3 at(Eigen::Vector3f(structure().x_m[i], structure().y_m[i], structure().z_m[i])
                                  .cast<double>());
                const Vec3 right_m = turn * (structure().home_com_model_m + at);
                farthest_m = std::max(farthest_m, (place.p_m + place.q * at - right_m).norm());
            }
            nearest_m = std::min(nearest_m, farthest_m);
        }
        return nearest_m / kAngstromM;
    }
    static std::string script(const std::string& text) {
        const std::string path = folder_ + "/program.sh";
        std::ofstream(path) << "#!/bin/sh\n" << text << std::flush;
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    static inline std::string folder_;
    static inline std::shared_ptr<const SceneContent> content_;
    const PlacementPrograms programs_{TACT_SEARCH, TACT_REFINE};
};

TEST_F(Placement, a_search_of_the_window_finds_a_place_of_the_subunit_from_anywhere) {
    if (too_slow_here()) GTEST_SKIP() << "not under a sanitizer";
    PlacementJob job(content_, programs_);
    const Pose lost{structure().home_com_model_m + Vec3(90e-10, -70e-10, 60e-10),
                    Quat(Eigen::AngleAxisd(2.0, Vec3(1.0, 2.0, -1.0).normalized()))};
    const PlacementOutcome outcome = result(job, {{1, 0, lost}, {}, PlaceObjective::laplacian, false});
    ASSERT_EQ(outcome.error, "");
    ASSERT_GE(outcome.found.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(away_a(outcome.found[i].T_model_body), 3.0) << i;
    EXPECT_GT(outcome.found[5].score, outcome.found[6].score + 0.05);
    EXPECT_GT(outcome.found[0].z, 4.0);
}

TEST_F(Placement, subtracted_bodies_leave_only_the_place_that_is_free) {
    if (too_slow_here()) GTEST_SKIP() << "not under a sanitizer";
    PlacementJob job(content_, programs_);
    std::vector<FitBody> others;
    for (int turns = 0; turns < 6; ++turns) {
        const Quat turn(Eigen::AngleAxisd(turns * std::numbers::pi / 3.0, Vec3::UnitZ()));
        if (turns != 2)
            others.push_back(
                {static_cast<std::uint32_t>(2 + turns), 0, {turn * structure().home_com_model_m, turn}});
    }
    const PlacementOutcome outcome =
        result(job, {{1, 0, structure().home()}, others, PlaceObjective::laplacian, false});
    ASSERT_EQ(outcome.error, "");
    ASSERT_FALSE(outcome.found.empty());
    const Quat turn(Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0, Vec3::UnitZ()));
    EXPECT_LT((outcome.found[0].T_model_body.p_m - turn * structure().home_com_model_m).norm(), 3e-10);
    EXPECT_LT(away_a(outcome.found[0].T_model_body), 3.0);
    EXPECT_LT(outcome.found[0].clashes, 200U);
}

TEST_F(Placement,
       refining_finds_the_place_from_ten_angstrom_and_twenty_degrees_by_each_objective_that_looks_around) {
    if (too_slow_here()) GTEST_SKIP() << "not under a sanitizer";
    PlacementJob job(content_, programs_);
    const Pose near{structure().home_com_model_m + 10e-10 * Vec3(0.6, 0.0, -0.8),
                    Quat(Eigen::AngleAxisd(20.0 * kDegreeRad, Vec3(1.0, -1.0, 0.5).normalized()))};
    for (const PlaceObjective by : {PlaceObjective::laplacian, PlaceObjective::correlation}) {
        const PlacementOutcome outcome = result(job, {{1, 0, near}, {}, by, true});
        ASSERT_EQ(outcome.error, "");
        ASSERT_EQ(outcome.found.size(), 1U);
        EXPECT_LT(away_a(outcome.found[0].T_model_body), 3.0);
        EXPECT_GT(outcome.found[0].score, outcome.found[0].score_start);
    }
    const PlacementOutcome uphill = result(job, {{1, 0, near}, {}, PlaceObjective::mean_density, true});
    ASSERT_EQ(uphill.error, "");
    EXPECT_GE(uphill.found.at(0).score, uphill.found[0].score_start);
}

TEST_F(Placement, a_cancelled_search_ends_at_once_and_finds_nothing) {
    PlacementJob job(content_, programs_);
    job.start({{1, 0, structure().home()}, {}, PlaceObjective::laplacian, false});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    job.cancel();
    std::optional<PlacementOutcome> done;
    for (int i = 0; i < 20'000 && !(done = job.poll()); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(done.has_value());
    EXPECT_TRUE(done->cancelled);
    EXPECT_EQ(done->error, "");
    EXPECT_TRUE(done->found.empty());
}

TEST_F(Placement, a_program_that_fails_is_reported_in_its_words) {
    const auto error = [&](const std::string& text) {
        const std::string program = script(text);
        PlacementJob job(content_, {program, program});
        return result(job, {{1, 0, structure().home()}, {}, PlaceObjective::laplacian, false}).error;
    };
    EXPECT_NE(error("echo '[ 10 %] reading' >&2; echo \"$0: the map is flat\" >&2; exit 1\n")
                  .find("the map is flat"),
              std::string::npos);
    EXPECT_NE(error("exit 7\n").find("code 7"), std::string::npos);
    EXPECT_NE(error("kill -9 $$\n").find("code 137"), std::string::npos);
    EXPECT_NE(error("exit 0\n"), "");  // writes nothing
    EXPECT_NE(error("head -c 3000000 /dev/zero > \"$7\"\n").find("megabyte"), std::string::npos);
}

// As the controller publishes it: bodies of the first structure, the first of them in the hand.
BodiesTopic topic_of(const std::vector<Pose>& places, std::uint32_t options) {
    BodiesTopic topic{};
    topic.count = static_cast<std::uint32_t>(places.size());
    topic.options = options;
    for (std::size_t i = 0; i < places.size(); ++i) {
        BodyPlace& b = topic.body[i];
        b.id = static_cast<std::uint32_t>(i + 1);
        Eigen::Map<Vec3>(b.pos_model_m) = places[i].p_m;
        Eigen::Map<Eigen::Vector4d>(b.quat_model_body_xyzw) = places[i].q.coeffs();
    }
    return topic;
}

class Finder : public Placement {
protected:
    void begin(const std::string& found_json, const std::vector<Pose>& places, std::uint32_t options) {
        const std::string program = script("cat > \"$7\" <<'END'\n" + found_json + "\nEND\n");
        finder_.emplace(PlacementPrograms{program, program});
        finder_->use(content_);
        topic_ = topic_of(places, options);
        const std::vector<Pose> homes{structure().home()};
        list_.start(homes);
        list_.follow(topic_);
    }
    PlaceFinder::Message look(bool nearby) {
        static_cast<void>(finder_->follow(list_, &topic_, commands_));
        EXPECT_TRUE(finder_->look(list_.bodies()[0], nearby, list_));
        for (int i = 0; i < 10'000; ++i) {
            if (auto message = finder_->follow(list_, &topic_, commands_)) return *message;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        ADD_FAILURE() << "timed out";
        return {};
    }
    std::optional<PlaceFinder> finder_;
    BodiesTopic topic_{};
    BodyList list_;
    std::vector<Command> commands_;
};

TEST_F(Finder, copies_of_a_symmetry_are_placed_with_new_bodies_and_move_together) {
    std::string hits;
    for (int i = 0; i < 3; ++i)
        hits.append(i > 0 ? "," : "")
            .append(R"({"score": 0.9, "z": 5, "clashes": 0, "matrix": [1,0,0,)")
            .append(std::to_string(10 * i))
            .append(",0,1,0,0,0,0,1,0]}");
    begin(R"({"hits": [)" + hits + R"(], "searches": [{"symmetry": {"name": "C3"}}]})",
          {structure().home(), structure().home()}, 0);
    SearchState state;
    std::snprintf(state.symmetry.data(), state.symmetry.size(), "find");
    finder_->describe(list_, &topic_, state);
    EXPECT_EQ(look(false).text, "");
    finder_->describe(list_, &topic_, state);
    EXPECT_EQ(state.found_symmetry, "C3") << "the one that was found, not the word that was typed";
    commands_.clear();
    const auto message = finder_->place_copies(list_.bodies()[0], list_, commands_);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->grade, Grade::good);
    ASSERT_EQ(commands_.size(), 4U);
    EXPECT_EQ(commands_[0].kind, CommandKind::place_body);
    EXPECT_EQ(commands_[0].body, 1U);
    EXPECT_EQ(commands_[1].kind, CommandKind::place_body);
    EXPECT_EQ(commands_[1].body, 2U) << "the copy that is there";
    EXPECT_EQ(commands_[2].kind, CommandKind::add_body);
    EXPECT_NEAR((commands_[2].T_model_body.p_m - structure().home_com_model_m).x(), 20e-10, 1e-16);
    EXPECT_EQ(commands_[3].kind, CommandKind::set_together);
    commands_.clear();
    topic_.body[0].pos_model_m[0] += 19e-10;
    list_.follow(topic_);
    ASSERT_TRUE(finder_->place_copies(list_.bodies()[0], list_, commands_));
    EXPECT_NEAR((commands_[0].T_model_body.p_m - structure().home_com_model_m).x(), 20e-10, 1e-16)
        << "to the nearest place";
    EXPECT_FALSE(finder_->place_copies(list_.bodies()[1], list_, commands_))
        << "not the body that was looked for";
}

TEST_F(Finder, without_a_symmetry_the_places_are_alternatives) {
    begin(R"({"hits": [{"score": 0.9, "z": 5, "clashes": 0, "matrix": [1,0,0,5,0,1,0,0,0,0,1,0]}]})",
          {structure().home()}, 0);
    EXPECT_EQ(look(false).text, "");
    EXPECT_FALSE(finder_->place_copies(list_.bodies()[0], list_, commands_));
}

TEST_F(Finder, refining_moves_the_copies_that_move_together) {
    const Quat half_turn(0, 0, 0, 1);
    const Pose home = structure().home(), copy{half_turn * home.p_m, half_turn * home.q};
    const std::string refined =
        R"({"bodies": [{"score_before": 0.5, "score_after": 0.7, "matrix": [1,0,0,3,0,1,0,0,0,0,1,0]}]})";
    begin(refined, {home, copy}, kDockingTogether);
    EXPECT_EQ(look(true).grade, Grade::good);
    ASSERT_EQ(commands_.size(), 2U);
    EXPECT_EQ(commands_[1].body, 2U);
    // 3 angstrom along x for the one is 3 angstrom against x for the other.
    EXPECT_NEAR((commands_[0].T_model_body.p_m - home.p_m).x(), 3e-10, 1e-16);
    EXPECT_NEAR((commands_[1].T_model_body.p_m - copy.p_m).x(), -3e-10, 1e-16);
    commands_.clear();
    begin(refined, {home, copy}, 0);
    EXPECT_EQ(look(true).grade, Grade::good);
    EXPECT_EQ(commands_.size(), 1U);
}

TEST(FoundPlaces, what_is_not_a_place_is_refused) {
    const auto error = [](const std::string& json) {
        return sample::error_of([&] { (void)read_found(json, Vec3::Zero(), false); });
    };
    const std::string motion = "[1,0,0,1, 0,1,0,2, 0,0,1,3]";
    const auto hit = [](const std::string& matrix, const std::string& score) {
        std::string text = R"({"hits": [{"z": 1, "clashes": 0, "score": )";
        text.append(score).append(R"(, "matrix": )").append(matrix).append("}]}");
        return text;
    };
    EXPECT_EQ(error(hit(motion, "0.5")), "");
    EXPECT_NE(error(hit("[1,0,0,1, 0,1,0,2, 0,0,-1,3]", "0.5")), "");  // mirrored
    EXPECT_NE(error(hit("[1,0,0,1, 0,1,0,2, 0,0,1.1,3]", "0.5")), "");
    EXPECT_NE(error(hit("[1,0,0,1e9, 0,1,0,2, 0,0,1,3]", "0.5")), "");
    EXPECT_NE(error(hit("[1,0,0]", "0.5")), "");
    EXPECT_NE(error(hit(motion, "null")), "");
    EXPECT_NE(error("{\"hits\": 3}"), "");
    EXPECT_NE(error("[]"), "");
    EXPECT_NE(error(""), "");
    EXPECT_NE(sample::error_of([] { (void)read_found(R"({"bodies": []})", Vec3::Zero(), true); }), "");
    for (const char* const none :
         {"", "[]", "{}", R"({"searches": []})", R"({"searches": [{"symmetry": 3}]})",
          R"({"searches": [{"symmetry": {"name": 7}}]})"})
        EXPECT_EQ(found_symmetry(none), "") << none;
    EXPECT_EQ(found_symmetry(R"({"searches": [{"symmetry": {"name": "C\n3"}}]})"), "C?3");
}

}  // namespace
}  // namespace tact::gui_placement_test
