// META, NOTE, GRID, BODY and CODE: round trips, and invalid values in each field, which a reader must refuse.
// All checksums are valid: the writer is the attacker.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "ipc/scene/file/bytes.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::scene_content_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

TEST(SceneContent, round_trips_exactly) {
    const auto bytes = sample::scene().to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "s");
    const SceneMeta meta = read_meta(file), m = sample::meta();
    EXPECT_EQ(std::memcmp(&meta, &m, sizeof m), 0);
    EXPECT_EQ(read_note(file), "map: sample\n");
    EXPECT_NEAR((meta.to_model(meta.to_world(Vec3(1e-9, 2e-9, 3e-9))) - Vec3(1e-9, 2e-9, 3e-9)).norm(), 0.0,
                1e-22);

    const DensityGrid grid = read_grid(file), g = sample::grid();
    EXPECT_EQ(grid.size, g.size);
    EXPECT_EQ(grid.origin_m, g.origin_m);
    EXPECT_EQ(grid.spacing_m, g.spacing_m);
    EXPECT_EQ(grid.values, g.values);

    const Structure structure = read_structure(file, 0), s = sample::structure();
    EXPECT_EQ(structure.name, s.name);
    EXPECT_EQ(structure.home_com_model_m, s.home_com_model_m);
    EXPECT_EQ(structure.mass_u, s.mass_u);
    EXPECT_EQ(structure.x_m, s.x_m);
    EXPECT_EQ(structure.y_m, s.y_m);
    EXPECT_EQ(structure.z_m, s.z_m);
    EXPECT_EQ(structure.mass_fraction, s.mass_fraction);
    EXPECT_EQ(structure.element, s.element);
    EXPECT_EQ(structure.chain, s.chain);
    EXPECT_EQ(structure.residue, s.residue);
    EXPECT_EQ(structure.trace, s.trace);
    EXPECT_EQ(structure.chain_names, s.chain_names);

    const Codebook codebook = read_codebook(file, 0), c = sample::codebook();
    ASSERT_EQ(codebook.levels.size(), c.levels.size());
    for (std::size_t l = 0; l < c.levels.size(); ++l) {
        EXPECT_EQ(codebook.levels[l].x_m, c.levels[l].x_m);
        EXPECT_EQ(codebook.levels[l].y_m, c.levels[l].y_m);
        EXPECT_EQ(codebook.levels[l].z_m, c.levels[l].z_m);
        EXPECT_EQ(codebook.levels[l].weight, c.levels[l].weight);
        EXPECT_EQ(codebook.levels[l].edges, c.levels[l].edges);
        EXPECT_EQ(codebook.levels[l].rms_error_m, c.levels[l].rms_error_m);
    }
}

// Reads all content of a scene and returns the error.
std::string refusal(const SceneWriter& out) {
    const auto bytes = out.to_bytes();
    return sample::error_of([&] {
        const SceneFile file = SceneFile::from_bytes(bytes, "hostile.tact");
        (void)read_meta(file);
        (void)read_note(file);
        (void)read_grid(file);
        (void)read_structure(file, 0);
        (void)read_codebook(file, 0);
    });
}

void expect_refused(const std::string& error, const char* section, const char* word) {
    EXPECT_NE(error.find("hostile.tact"), std::string::npos) << word << ": " << error;
    EXPECT_NE(error.find(section), std::string::npos) << word << ": " << error;
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_NE(error.find("fix:"), std::string::npos) << error;
}

TEST(SceneContent, every_field_of_meta_is_checked) {
    const auto refused = [](const char* word, const std::function<void(SceneMeta&)>& spoil) {
        SceneMeta m = sample::meta();
        spoil(m);
        expect_refused(refusal(sample::scene(m)), "META", word);
    };
    refused("kind", [](SceneMeta& m) { m.kind = static_cast<SceneKind>(9); });
    refused("body_count", [](SceneMeta& m) { m.body_count = 0; });
    refused("body_count", [](SceneMeta& m) { m.body_count = 4'000'000'000U; });
    refused("body_count", [](SceneMeta& m) { m.body_count = 2; });
    for (const double bad : {kNan, -1.0, 0.0, 1e300}) {
        refused("world_per_model", [bad](SceneMeta& m) { m.world_per_model = bad; });
        refused("energy_j_per_sigma", [bad](SceneMeta& m) { m.energy_j_per_sigma = bad; });
        refused("map_sigma", [bad](SceneMeta& m) { m.map_sigma = bad; });
    }
    for (const double bad : {kNan, -1e300, 1e300}) {
        refused("centre_model_m", [bad](SceneMeta& m) { m.centre_model_m[2] = bad; });
        refused("map_mean", [bad](SceneMeta& m) { m.map_mean = bad; });
        refused("map_background", [bad](SceneMeta& m) { m.map_background = bad; });
        refused("contour", [bad](SceneMeta& m) { m.contour = bad; });
        refused("resolution_m", [bad](SceneMeta& m) { m.resolution_m = bad; });
        refused("resolution_m",
                [](SceneMeta& m) { m.resolution_m = 0.0; });  // of a docking scene it is never unknown
    }
    refused("title", [](SceneMeta& m) { std::memset(m.title, 'x', sizeof m.title); });
    refused("title", [](SceneMeta& m) { m.title[0] = '\x1b'; });
    expect_refused(refusal(sample::scene(sample::meta(), sample::structure(), sample::codebook(),
                                         sample::grid(), "\x1b[2J")),
                   "NOTE", "control character");
}

TEST(SceneContent, every_field_of_the_grid_is_checked) {
    const auto refused = [](const char* word, const std::function<void(DensityGrid&)>& spoil) {
        DensityGrid g = sample::grid();
        spoil(g);
        expect_refused(refusal(sample::scene(sample::meta(), sample::structure(), sample::codebook(), g)),
                       "GRID", word);
    };
    refused("voxels", [](DensityGrid& g) { g.size[0] = 6; });
    refused("follow its content", [](DensityGrid& g) { g.size[0] = 4; });
    refused("along an axis", [](DensityGrid& g) { g.size[1] = 0; });
    refused("along an axis", [](DensityGrid& g) { g.size[2] = 0xffffffffU; });
    refused("voxels", [](DensityGrid& g) { g.size = {8192, 8192, 8192}; });
    refused("voxel", [](DensityGrid& g) { g.values[7] = kNanF; });
    refused("voxel", [](DensityGrid& g) { g.values.back() = -kInfF; });
    for (const double bad : {kNan, 1e300}) refused("origin", [bad](DensityGrid& g) { g.origin_m.y() = bad; });
    for (const double bad : {kNan, 0.0, -1e-10, 1e300})
        refused("wide", [bad](DensityGrid& g) { g.spacing_m.z() = bad; });
}

TEST(SceneContent, every_field_of_a_structure_is_checked) {
    const auto refused = [](const char* word, const std::function<void(Structure&)>& spoil) {
        Structure s = sample::structure();
        spoil(s);
        expect_refused(refusal(sample::scene(sample::meta(), s)), "BODY 0", word);
    };
    refused("no atoms", [](Structure& s) { s = Structure{}; });
    refused("chains", [](Structure& s) { s.chain_names.clear(); });
    refused("home", [](Structure& s) { s.home_com_model_m.x() = kNan; });
    refused("mass", [](Structure& s) { s.mass_u = kNan; });
    refused("mass", [](Structure& s) { s.mass_u = 0.0; });
    refused("name", [](Structure& s) { s.name = std::string(5000, 'x'); });
    refused("name", [](Structure& s) { s.name = "a\nb"; });
    refused("chain name", [](Structure& s) { s.chain_names[0] = std::string(65, 'A'); });
    refused("x of atom 1", [](Structure& s) { s.x_m[1] = kNanF; });
    refused("y of atom 2", [](Structure& s) { s.y_m[2] = 1.0F; });
    refused("z of atom 0", [](Structure& s) { s.z_m[0] = -kInfF; });
    refused("sum to", [](Structure& s) { s.mass_fraction[0] = 0.5F; });
    refused("weight", [](Structure& s) { s.mass_fraction = {-0.25F, 1.0F, 0.25F}; });
    refused("weight", [](Structure& s) { s.mass_fraction[0] = kNanF; });
    refused("chain 2", [](Structure& s) { s.chain[1] = 2; });
    refused("element 119", [](Structure& s) { s.element[1] = 119; });
    refused("trace", [](Structure& s) { s.trace[1] = 2; });
    refused("follow its content", [](Structure& s) { s.trace.push_back(0); });
    refused("trace", [](Structure& s) { s.trace.pop_back(); });
}

TEST(SceneContent, every_field_of_a_codebook_is_checked) {
    const auto refused = [](const char* word, const std::function<void(Codebook&)>& spoil) {
        Codebook c = sample::codebook();
        spoil(c);
        expect_refused(refusal(sample::scene(sample::meta(), sample::structure(), c)), "CODE 0", word);
    };
    refused("257 levels", [](Codebook& c) { c.levels.resize(257); });
    refused("no points", [](Codebook& c) { c.levels[0] = {}; });
    refused("not more than", [](Codebook& c) { std::swap(c.levels[0], c.levels[1]); });
    refused("error of level 1", [](Codebook& c) { c.levels[1].rms_error_m = kNan; });
    refused("error of level 0", [](Codebook& c) { c.levels[0].rms_error_m = -1e-10; });
    refused("x of point 1", [](Codebook& c) { c.levels[1].x_m[1] = kNanF; });
    refused("y of point 0", [](Codebook& c) { c.levels[0].y_m[0] = 1.0F; });
    refused("z of point 1", [](Codebook& c) { c.levels[1].z_m[1] = kInfF; });
    refused("sum to", [](Codebook& c) { c.levels[1].weight[0] = 0.9F; });
    refused("weight", [](Codebook& c) { c.levels[1].weight = {-1.0F, 2.0F}; });
    refused("edge", [](Codebook& c) { c.levels[1].edges[0] = {0, 2}; });
    refused("edge", [](Codebook& c) { c.levels[1].edges[0] = {1, 1}; });
}

TEST(SceneContent, a_codebook_without_levels_is_valid) {
    const auto bytes = sample::scene(sample::meta(), sample::structure(), Codebook{}).to_bytes();
    EXPECT_TRUE(read_codebook(SceneFile::from_bytes(bytes, "s"), 0).levels.empty());
}

TEST(SceneContent, every_section_cut_anywhere_is_refused_without_reading_past_its_end) {
    const auto bytes = sample::scene().to_bytes();
    const SceneFile whole = SceneFile::from_bytes(bytes, "s");
    struct Case {
        SectionTag tag;
        std::function<void(const SceneFile&)> read;
    };
    const Case cases[] = {
        {{'M', 'E', 'T', 'A'}, [](const SceneFile& f) { (void)read_meta(f); }},
        {{'G', 'R', 'I', 'D'}, [](const SceneFile& f) { (void)read_grid(f); }},
        {{'B', 'O', 'D', 'Y'}, [](const SceneFile& f) { (void)read_structure(f, 0); }},
        {{'C', 'O', 'D', 'E'}, [](const SceneFile& f) { (void)read_codebook(f, 0); }},
    };
    for (const Case& c : cases) {
        const auto section = whole.section(c.tag, 1);
        for (std::size_t n = 0; n < section.size(); ++n) {
            SceneWriter out;
            out.add(c.tag, 1, 0, {section.begin(), section.begin() + static_cast<std::ptrdiff_t>(n)});
            const auto cut = out.to_bytes();
            const SceneFile file = SceneFile::from_bytes(cut, "cut");
            ASSERT_THROW(c.read(file), StartupError) << c.tag[0] << " at " << n;
        }
    }
}

TEST(SceneContent, hostile_counts_are_refused_before_memory_is_taken) {
    BytesOut bytes;
    bytes.put(std::uint32_t{1});  // one level
    bytes.put(std::uint32_t{0});
    bytes.put(std::uint32_t{0xffffffff});  // points
    bytes.put(std::uint32_t{0xffffffff});  // edges
    bytes.put(0.0);
    SceneWriter out;
    out.add({'C', 'O', 'D', 'E'}, 1, 0, bytes.take());
    const auto content = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(content, "hostile.tact");
    expect_refused(sample::error_of([&] { (void)read_codebook(file, 0); }), "CODE 0", "are left");
}

}  // namespace
}  // namespace tact::scene_content_test
