#include "gui/window/load_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gui/drilling/bone_field.hpp"

namespace tact {
namespace {

struct Box {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    void add(const Vec3& p) {
        if (!p.allFinite()) return;
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    [[nodiscard]] bool empty() const { return low.x() > high.x(); }
};

void find_extent(SceneContent& content) {
    Box box;
    const auto at = [](const PackedVertex& v) {
        return Vec3(v.position_m[0], v.position_m[1], v.position_m[2]);
    };
    if (content.mesh) content.mesh->each_original([&](const PackedVertex& v) { box.add(at(v)); });
    for (const Structure& s : content.bodies)
        for (std::size_t i = 0; i < s.size(); ++i)
            box.add(s.home_com_model_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i]));
    if (box.empty()) {
        box.add(content.box_min_model_m);
        box.add(content.box_max_model_m);
    }
    content.centre_model_m = 0.5 * (box.low + box.high);
    // One angstrom at least; of bone, its box.
    double most = 1e-10;
    if (!content.mesh && content.bodies.empty())
        most = std::max(most, (box.high - content.centre_model_m).norm());
    const auto reach = [&](const Vec3& p) { most = std::max(most, (p - content.centre_model_m).norm()); };
    if (content.mesh) content.mesh->each_original([&](const PackedVertex& v) { reach(at(v)); });
    for (const Structure& s : content.bodies)
        for (std::size_t i = 0; i < s.size(); ++i)
            reach(s.home_com_model_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i]));
    content.radius_m = most;
}

}  // namespace

std::shared_ptr<const SceneContent> load_scene(const std::filesystem::path& path) {
    SceneFile file = SceneFile::open(path);
    auto content = std::make_shared<SceneContent>();
    content->path = path;
    content->checksum = file.checksum();
    content->meta = read_meta(file);
    content->note = read_note(file);
    if (file.count({'M', 'E', 'S', 'H'}) > 0)
        content->mesh = std::make_unique<ProgressiveMesh>(read_mesh(file, 0));
    std::optional<BoneVolumeView> bone;
    if (content->meta.kind == SceneKind::drilling) {
        bone = read_bone_volume(file);
        const BoneBricks& bricks = bone->bricks;
        content->box_min_model_m = bricks.to_model(Vec3::Constant(-0.5));
        content->box_max_model_m =
            bricks.to_model(Vec3(bricks.size[0], bricks.size[1], bricks.size[2]).array() - 0.5);
    }
    if (has_touch_tool(file)) content->tool = std::make_unique<TouchTool>(read_touch_tool(file));
    if (file.count({'G', 'R', 'I', 'D'}) > 0) {
        content->grid = read_grid(file);
        content->scale = ContourScale(content->grid, content->meta.map_mean, content->meta.map_sigma);
        content->box_min_model_m = content->grid.origin_m;
        for (int axis = 0; axis < 3; ++axis)
            content->box_max_model_m[axis] =
                content->grid.origin_m[axis] +
                content->grid.spacing_m[axis] * (content->grid.size[static_cast<std::size_t>(axis)] - 1.0);
    }
    const std::uint32_t bodies = std::min(file.count({'B', 'O', 'D', 'Y'}), content->meta.body_count);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        content->bodies.push_back(read_structure(file, i));
        content->codebooks.push_back(i < file.count({'C', 'O', 'D', 'E'}) ? read_codebook(file, i)
                                                                          : Codebook{});
        content->bonds.push_back(find_bonds(content->bodies.back()));
    }
    find_extent(*content);
    if (bone) {
        BoneLabelsView labels;
        if (has_bone_labels(file)) labels = read_bone_labels(file, bone->bricks);
        std::vector<DistanceField> distances = read_distance_fields(file, labels.structure.size());
        content->bone.reset(
            new SceneBoneContent{std::move(file), *bone, std::move(labels), std::move(distances)});
        SceneBoneContent& b = *content->bone;
        const BoneField field(b.volume, b.labels, b.volume);
        b.free_cells.assign(field.free_cells().begin(), field.free_cells().end());
        return content;
    }
    if (content->meta.kind == SceneKind::surface && file.count({'F', 'R', 'S', 'T'}) > 0) {
        const SurfaceMesh surface = read_surface(file);
        const VertexForest forest = read_forest(file, surface.all_positions_m(), surface.all_corners());
        content->detail.reset(new SurfaceDetail{std::move(file), surface, forest});
    }
    return content;
}

}  // namespace tact
