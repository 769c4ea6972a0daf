// Baked scenes. The first byte selects: 0 uses the input as a whole file; otherwise the input is one section of a file with
// valid checksums, so that its reader is reached. Accepted scenes are used as the programs use
// them.
#include <cstdlib>
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"
#include "ipc/scene/mesh/refinement.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/surface/build_surface.hpp"
#include "prep/surface/forest_builder.hpp"
#include "prep/surface/sample_tool.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::fuzz {
namespace {

constexpr SectionTag kTags[] = {{'M', 'E', 'T', 'A'}, {'N', 'O', 'T', 'E'}, {'G', 'R', 'I', 'D'},
                                {'B', 'O', 'D', 'Y'}, {'C', 'O', 'D', 'E'}, {'M', 'E', 'S', 'H'},
                                {'S', 'U', 'R', 'F'}, {'F', 'R', 'S', 'T'}, {'T', 'O', 'O', 'L'},
                                {'B', 'O', 'N', 'E'}, {'L', 'A', 'B', 'L'}, {'D', 'I', 'S', 'T'},
                                {'M', 'O', 'D', 'E'}, {'P', 'A', 'T', 'I'}};

template <class Read>
std::size_t accepted(Read&& read) {
    try {
        read();
        return 1;
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
    }
    return 0;
}

// The surface for which every forest is read.
struct Terrain {
    TriangleMesh mesh = [] {
        TriangleMesh made;
        for (std::uint32_t i = 0; i < 36; ++i) {
            const auto x = static_cast<float>(i % 6), y = static_cast<float>(i / 6);
            made.position_m.insert(made.position_m.end(), {x, y, 0.2F * x * y - y});
            if (i % 6 == 5 || i / 6 == 5) continue;
            made.triangle.insert(made.triangle.end(), {i, i + 1, i + 7, i, i + 7, i + 6});
        }
        return made;
    }();
    BuiltForest forest = build_forest(mesh);
};
const Terrain& terrain() {
    static const Terrain made;
    return made;
}

// Ten voxels along x: two bricks.
void write_bone(SceneWriter& out) {
    const BoneBricks bricks{{10, 3, 2}, 1e-3, Vec3::Zero()};
    std::vector<std::uint8_t> density(bricks.bytes()), label(bricks.bytes());
    for (std::uint32_t x = 0; x < 10; ++x) {
        density[bricks.voxel(x, 1, 1)] = static_cast<std::uint8_t>(20 * x);
        label[bricks.voxel(x, 2, 0)] = static_cast<std::uint8_t>(x % 3);
    }
    BoneVolumeView volume;
    volume.bricks = bricks;
    volume.density = density;
    write_bone_volume(out, volume);
    write_bone_labels(out, bricks, {{{"nerve", {1, 2, 3, 4}, true}, {"incus", {}, false}}, label});
    const std::vector<std::int16_t> quanta(12, 50);
    write_distance_field(out, 0, {1, {3, 2, 2}, 4e-3, Vec3::Zero(), 1e-4, 4e-3, quanta});
    write_patient_frame(out, {});
}

// One valid section per tag.
const std::vector<Input>& good_sections() {
    static const std::vector<Input> sections = [] {
        SceneWriter scene = sample::scene();
        TriangleMesh octahedron;
        octahedron.position_m = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
        octahedron.triangle = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
        write_progressive_mesh(scene, 0, octahedron);
        write_surface(scene, build_surface(octahedron));
        write_forest(scene, terrain().forest.data);
        write_touch_tool(scene, sample_tool(octahedron, {.points = 12}));
        write_bone(scene);
        // All atoms by the same step: a mode as far as the reader can tell.
        NormalModes modes;
        modes.node = residue_nodes(sample::structure());
        modes.stiffness = {1.0F, 2.0F};
        modes.x.assign(2 * modes.nodes(), 0.6F);
        modes.y.assign(2 * modes.nodes(), 0.0F);
        modes.z.assign(2 * modes.nodes(), 0.8F);
        write_modes(scene, 0, modes);
        const Input bytes = scene.to_bytes();
        const SceneFile file = SceneFile::from_bytes(bytes, "good.tact");
        std::vector<Input> good;
        for (const SectionTag& tag : kTags) {
            const auto section = file.section(tag, 1);
            good.emplace_back(section.begin(), section.end());
        }
        return good;
    }();
    return sections;
}

void use_grid(const SceneFile& file) {
    const DensityGrid grid = read_grid(file);
    require(grid.values.size() == grid.count());
    if (grid.count() > 100'000) return;
    const DensityMap map(grid, 0.0, 1.0);
    Vec3 gradient;
    (void)map.sample(grid.origin_m + 1.5 * grid.spacing_m, gradient);
    (void)map.sample(Vec3(1e300, -1e300, 0.0), gradient);
}

void use_structure(const SceneFile& file) {
    const Structure s = read_structure(file, 0);
    require(s.y_m.size() == s.size() && s.chain.size() == s.size() && s.trace.size() == s.size());
    for (const std::uint16_t chain : s.chain) require(chain < s.chain_names.size());
}

void use_codebook(const SceneFile& file) {
    for (const Codebook::Level& level : read_codebook(file, 0).levels) {
        require(level.weight.size() == level.size());
        for (const auto& edge : level.edges) require(edge[0] < level.size() && edge[1] < level.size());
    }
}

void use_modes(const SceneFile& file) {
    const Structure s = read_structure(file, 0);
    const NormalModes modes = read_modes(file, 0, s);
    const float amplitude_m[] = {1e-10F, -1e-10F};
    require(bent_structure(s, modes, amplitude_m).size() == s.size());
}

void use_mesh(const SceneFile& file) {
    const ProgressiveMesh mesh = read_mesh(file, 0);
    MeshCut cut(mesh);
    for (const std::uint32_t n : {mesh.vertices(), mesh.vertices_min(), mesh.vertices() / 2}) {
        cut.set_vertices(n);
        for (const MeshRange draw : cut.draws())
            for (const std::uint32_t i : cut.index().subspan(draw.first, draw.count))
                require(i < cut.vertices());
    }
}

void use_surface(const SceneFile& file) {
    const SurfaceMesh mesh = read_surface(file);
    const Vec3 centre = 0.5 * (mesh.low_m() + mesh.high_m());
    std::array<std::uint32_t, kLooks> leaves;
    for (const Vec3& p : {centre, mesh.high_m(), Vec3(1e300, -1e300, 0.0)}) {
        const SurfacePoint found = mesh.nearest(p, 1e7, 0);
        if (found.triangle != SurfacePoint::kNone) (void)mesh.normal_at(found);
        std::size_t count = 0;
        (void)mesh.leaves_near(p, 1.0, leaves, count);
        std::array<std::uint32_t, kLooks> first{};
        for (std::size_t i = 0; i < count; ++i) first[i] = SurfaceNode::leaf_first(leaves[i]);
        QueryJob job = mesh.query_job(p);
        job.triangle = first.data();
        TriangleQueries seen;
        best_query_kernel().query(job, seen);
    }
}

void use_forest(const SceneFile& file) {
    const TriangleMesh& mesh = terrain().mesh;
    const VertexForest forest = read_forest(file, mesh.position_m, mesh.triangle);
    RefinementSettings settings;
    settings.filter = RefineFilter::bell(0.5F, 2.0F, 0.3F);
    settings.splits_max = 9;
    settings.nodes_max = std::max(forest.roots(), 30U);
    Refinement refinement(forest, settings);
    for (int i = 0; i < 12; ++i) {
        refinement.step(Vec3(0.5 * i, 5.0 - 0.5 * i, 1.0), Vec3(i % 3, 0.0, 0.0));
        refinement.each_triangle([&](std::uint32_t t, const std::array<std::uint32_t, 3>& at) {
            require(t < mesh.triangles());
            for (std::size_t k = 0; k < 3; ++k)
                require(at[k] == refinement.place_of(mesh.triangle[3 * std::size_t{t} + k]));
            require(at[0] != at[1] && at[1] != at[2] && at[2] != at[0]);
        });
    }
}

// Steps every accepted tool over the octahedron.
void use_tool(const SceneFile& file) {
    const TouchTool tool = read_touch_tool(file);
    require(tool.normal.size() == tool.points() && tool.cover_m.size() == tool.points());
    for (const std::uint32_t v : tool.drawn) require(v < tool.drawn_m.size() / 3);
    static const std::vector<std::byte> bytes = [] {
        SceneWriter out;
        TriangleMesh mesh;
        mesh.position_m = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
        mesh.triangle = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
        write_surface(out, build_surface(mesh));
        return out.to_bytes();
    }();
    const SceneFile surface = SceneFile::from_bytes(bytes, "surface");
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = 0.01;
    ToolModel model(meta, read_surface(surface), tool, {});
    ToolState hand;
    model.reset(hand);
    for (int i = 0; i < 8; ++i) {
        hand.T_world_tool.p_m = Vec3(0.02 - 0.004 * i, 0.003, 0.002 * i);
        require(model.step(hand, {}).wrench_world.finite());
    }
}

void use_bone(const SceneFile& file) {
    const BoneVolumeView bone = read_bone_volume(file);
    require(bone.density.size() == bone.bricks.bytes());
    const auto& n = bone.bricks.size;
    (void)bone.at(n[0] - 1, n[1] - 1, n[2] - 1);
}

// Uses labels with the bone of write_bone().
void use_labels(const SceneFile& file) {
    const BoneBricks bricks{{10, 3, 2}, 1e-3, Vec3::Zero()};
    const BoneLabelsView labels = read_bone_labels(file, bricks);
    for (const std::uint8_t l : labels.label) (void)labels.critical(l);
}

void use_patient(const SceneFile& file) {
    const std::optional<PatientFrame> frame = read_patient_frame(file);
    if (!frame) throw StartupError("read the patient's frame", "there is none", "add one");
    const Vec3 p_m(0.01, -0.02, 0.03);
    require((frame->model_m(frame->patient_mm(p_m)) - p_m).norm() < 1e-6);
}

void use_distances(const SceneFile& file) {
    for (const DistanceField& f : read_distance_fields(file, 2))
        for (const Vec3& p : {Vec3(0, 0, 0), f.origin_m, Vec3(0.005, 0.001, 0.001), Vec3(1e300, -1e300, 0.0)})
            (void)f.distance_m(p);
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const auto kind = static_cast<std::size_t>(input[0]) % (1 + std::size(kTags));
    const auto rest = input.subspan(1);
    Input made(rest.begin(), rest.end());  // at an address like that of a mapped file
    if (kind > 0) {
        SceneWriter out;
        for (std::size_t i = 0; i < std::size(kTags); ++i)
            out.add(kTags[i], 1, 0, i + 1 == kind ? Input(rest.begin(), rest.end()) : good_sections()[i]);
        made = out.to_bytes();
    }
    std::size_t sections = 0;
    accepted([&] {
        const SceneFile file = SceneFile::from_bytes(made, "fuzz.tact");
        sections += accepted([&] { (void)read_meta(file); });
        sections += accepted([&] { (void)read_note(file); });
        sections += accepted([&] { use_grid(file); });
        sections += accepted([&] { use_structure(file); });
        sections += accepted([&] { use_codebook(file); });
        sections += accepted([&] { use_mesh(file); });
        sections += accepted([&] { use_surface(file); });
        sections += accepted([&] { use_forest(file); });
        sections += accepted([&] { use_tool(file); });
        sections += accepted([&] { use_bone(file); });
        sections += accepted([&] { use_labels(file); });
        sections += accepted([&] { use_distances(file); });
        sections += accepted([&] { use_modes(file); });
        sections += accepted([&] { use_patient(file); });
    });
    return sections == std::size(kTags);
}

std::vector<Input> seeds() {
    SceneWriter scene;
    std::vector<Input> all;
    for (std::size_t i = 0; i < std::size(kTags); ++i) {
        const Input& section = good_sections()[i];
        scene.add(kTags[i], 1, 0, section);
        Input seed(1, static_cast<std::byte>(i + 1));
        seed.insert(seed.end(), section.begin(), section.end());
        all.push_back(std::move(seed));
    }
    const Input bytes = scene.to_bytes();
    all.emplace_back(1, std::byte{0});
    all.back().insert(all.back().end(), bytes.begin(), bytes.end());
    return all;
}

}  // namespace tact::fuzz
