// Scenes that get more structures: what they were baked from, where bodies start, and the session that continues in them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "ipc/scene/density/start_place.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/session/extend_session.hpp"
#include "tests/support/error_of.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::scene_extend_test {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& lines) {
    std::string note = "map: a\n";
    for (const std::string& line : lines) note += line + '\n';
    return note;
}

BakeRecord record() {
    return {{{"map", "56 bytes, crc32 7ada8fab", "/data/emd, new.mrc"},
             {"half-map", "1 bytes, crc32 00000000", "/a"},
             {"half-map", "1 bytes, crc32 00000001", "/b"},
             {"structure", "948 bytes, crc32 85572189", "/data/1oel.pdb"}},
            {"--resolution-a", "9.3", "--contour", "-1e-05"}};
}

TEST(BakeRecord, is_read_from_the_note_that_it_wrote) {
    const auto read = read_bake_record(joined(note_lines(record())));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->inputs, record().inputs);
    EXPECT_EQ(read->options, record().options);
    EXPECT_EQ(read->paths("half-map"), (std::vector<std::string>{"/a", "/b"}));
}

TEST(BakeRecord, old_notes_and_damaged_ones_have_none) {
    EXPECT_FALSE(
        read_bake_record("map: /a.mrc\nstructure: /b.pdb\nstructure check: 1 bytes, crc32 00000000\n"));
    const std::string good = "input: map, 5 bytes, crc32 00000000, /a\nbake options: --modes 3\n";
    EXPECT_TRUE(read_bake_record(good));
    for (const auto& [was, by] : {std::pair("/a", "a"),
                                  {"map, ", ", "},
                                  {"5 bytes", "five bytes"},
                                  {"00000000", "0000zzzz"},
                                  {"bake options: ", ""},
                                  {"--modes", "-o"},
                                  {"--modes", "--Modes"},
                                  {"3", "/etc/passwd"},
                                  {"3", "3;ls"},
                                  {"bake options: ", "bake options: \nbake options: "},
                                  {"input", "output"}}) {
        std::string note = good;
        note.replace(note.find(was), std::string(was).size(), by);
        EXPECT_FALSE(read_bake_record(note)) << note;
    }
    BakeRecord many = record();
    many.inputs.resize(BakeRecord::kInputsMost + 1, many.inputs[0]);
    EXPECT_FALSE(read_bake_record(joined(note_lines(many))));
}

TEST(BakeRecord, a_file_that_is_gone_or_changed_is_named_with_its_role) {
    const fs::path file = fs::temp_directory_path() / ("tact-extend-" + std::to_string(getpid()));
    std::ofstream(file) << "one";
    const BakeRecord of_file{{bake_input("mask", file)}, {}};
    EXPECT_EQ(sample::error_of([&] { check_unchanged(of_file, "trying"); }), "");
    std::ofstream(file) << "two";
    const std::string changed = sample::error_of([&] { check_unchanged(of_file, "trying"); });
    EXPECT_NE(changed.find("its mask, the file " + file.string() + ", has changed"), std::string::npos)
        << changed;
    fs::remove(file);
    const std::string gone = sample::error_of([&] { check_unchanged(of_file, "trying"); });
    EXPECT_NE(gone.find("no longer there"), std::string::npos) << gone;
    EXPECT_NE(gone.find("fix:"), std::string::npos) << gone;
}

TEST(BakeRecord, more_files_with_the_same_options_extend_it) {
    BakeRecord more = record();
    more.inputs.push_back({"structure", "7 bytes, crc32 00000007", "/c.pdb"});
    EXPECT_TRUE(extends(more, record()));
    EXPECT_TRUE(extends(record(), record()));
    EXPECT_FALSE(extends(record(), more));
    more.options.back() = "2";
    EXPECT_FALSE(extends(more, record()));
    BakeRecord other = record();
    other.inputs[0].mark = "57 bytes, crc32 7ada8fab";
    EXPECT_FALSE(extends(other, record()));
}

// In the map, as sample::structure() is not.
Structure inside() {
    Structure s = sample::structure();
    s.name = "inside.pdb";
    s.home_com_model_m = sample::grid().origin_m + Vec3(1e-10, 2e-10, 3e-10);
    return s;
}

TEST(StartPlace, is_that_of_the_file_within_reach_and_else_beside_the_map_clear_of_others) {
    const DensityGrid grid = sample::grid();
    const std::vector<Structure> three{inside(), sample::structure(), sample::structure()};
    const std::vector<Pose> at = start_places(grid, three);
    EXPECT_EQ(at[0].p_m, three[0].home_com_model_m);
    EXPECT_TRUE(overlaps(grid, three[0], at[0]));
    const double edge_m = grid.origin_m.x() + 4 * grid.spacing_m.x(),
                 radius_m = ball_of(three[1], at[1]).radius_m;
    EXPECT_GT(at[1].p_m.x() - radius_m, edge_m);
    EXPECT_LT(at[1].p_m.x() - radius_m, edge_m + 0.2 * radius_m + 1e-10);
    EXPECT_GT((at[2].p_m - at[1].p_m).norm(), 2.0 * radius_m);
    EXPECT_FALSE(overlaps(grid, three[1], at[1]));
    EXPECT_NEAR(outside_m(grid, grid.origin_m - Vec3(0, 3e-10, 4e-10)), 5e-10, 1e-18);
}

class Extended : public testing::Test {
protected:
    static SceneFile scene(std::uint32_t bodies, std::vector<std::byte>& bytes) {
        SceneMeta meta = sample::meta();
        meta.body_count = bodies;
        SceneWriter out;
        write_meta(out, meta, "made by a test\n");
        write_grid(out, sample::grid());
        const Structure all[] = {inside(), inside(), sample::structure()};
        for (std::uint32_t i = 0; i < bodies; ++i) write_structure(out, i, all[i]);
        bytes = out.to_bytes();
        return SceneFile::from_bytes(bytes, "/scenes/" + std::to_string(bodies) + ".tact");
    }
    std::vector<std::byte> one_bytes_, three_bytes_;
    SceneFile one_ = scene(1, one_bytes_), three_ = scene(3, three_bytes_);
};

TEST_F(Extended, bodies_keep_their_places_and_new_ones_are_added) {
    Session session;
    session.scene = one_.name();
    session.scene_checksum = one_.checksum();
    char checksum[40];
    std::snprintf(checksum, sizeof checksum, "checksum = \"%016llx\"\n",
                  static_cast<unsigned long long>(one_.checksum()));
    session.window = checksum;
    session.bodies =
        R"([{"id":3,"structure":0,"name":"inside.pdb","pos_model_a":[1,2,3],"quat_model_body_xyzw":[0,0,1,0],"fixed":true},)"
        R"({"id":5,"structure":0,"pos_model_a":[4,5,6],"quat_model_body_xyzw":[0,0,0,1],"fixed":false}])";
    session.contours = {"0.75"};
    session.places = {{"before", {{5, {}}, {4, {}}}}, {"of a removed body", {{4, {}}}}};
    const Session more = extended_session(session, one_, three_);
    EXPECT_EQ(more.scene, "/scenes/3.tact");
    EXPECT_EQ(more.scene_checksum, three_.checksum());
    EXPECT_EQ(more.window.find(checksum), std::string::npos) << "the view is for the new scene";
    EXPECT_EQ(more.window.size(), session.window.size());
    EXPECT_EQ(more.contours, session.contours);
    const auto bodies = nlohmann::json::parse(more.bodies);
    ASSERT_EQ(bodies.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(bodies[i]["id"], i + 1);
        EXPECT_EQ(bodies[i]["structure"], i < 2 ? 0U : i - 1U);
        EXPECT_EQ(bodies[i]["in_hand"], i == 2) << "the first that is new";
        EXPECT_EQ(bodies[i]["fixed"], i == 0);
    }
    EXPECT_EQ(bodies[0]["pos_model_a"], (nlohmann::json{1, 2, 3}));
    EXPECT_EQ(bodies[0]["quat_model_body_xyzw"], (nlohmann::json{0, 0, 1, 0}));
    EXPECT_NEAR(bodies[2]["pos_model_a"][0].get<double>(), 1e10 * inside().home_com_model_m.x(), 1e-9);
    EXPECT_GT(bodies[3]["pos_model_a"][0].get<double>(), -10.0 + 4.0) << "beside the map";
    ASSERT_EQ(more.places.size(), 1U) << "what no body is left of";
    ASSERT_EQ(more.places[0].bodies.size(), 1U);
    EXPECT_EQ(more.places[0].bodies[0].id, 2U) << "snapshots follow the new numbers";
}

TEST_F(Extended, without_bodies_all_structures_are_there_and_what_adds_nothing_is_refused) {
    Session session;
    session.scene = one_.name();
    const auto bodies = nlohmann::json::parse(extended_session(session, one_, three_).bodies);
    ASSERT_EQ(bodies.size(), 3U);
    EXPECT_EQ(bodies[2]["name"], "three.pdb");
    EXPECT_NE(
        sample::error_of([&] { (void)extended_session(session, three_, one_); }).find("no more structures"),
        std::string::npos);
    session.bodies = "[3]";
    EXPECT_NE(sample::error_of([&] { (void)extended_session(session, one_, three_); }).find("not a list"),
              std::string::npos);
    session.bodies = R"([{"structure":99},{"structure":0,"pos_model_a":["x",0,0]},{}])";
    EXPECT_EQ(nlohmann::json::parse(extended_session(session, one_, three_).bodies).size(), 5U)
        << "the controller judges them";
}

}  // namespace
}  // namespace tact::scene_extend_test
