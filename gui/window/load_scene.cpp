#include "gui/window/load_scene.hpp"

#include <algorithm>
#include <utility>

#include "gui/window/systems.hpp"

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

void each_point(const SceneContent& content, const std::function<void(const Vec3&)>& take) {
    if (content.mesh)
        content.mesh->each_original(
            [&](const PackedVertex& v) { take(Vec3(v.position_m[0], v.position_m[1], v.position_m[2])); });
    content.system->each_point(take);
}

void find_extent(SceneContent& content) {
    Box box;
    each_point(content, [&](const Vec3& p) { box.add(p); });
    const bool nothing = box.empty();
    if (nothing) {
        box.add(content.box_min_model_m);
        box.add(content.box_max_model_m);
    }
    content.centre_model_m = 0.5 * (box.low + box.high);
    // At least one angstrom; the box if nothing else is drawn.
    double most = 1e-10;
    if (nothing) most = std::max(most, (box.high - content.centre_model_m).norm());
    each_point(content, [&](const Vec3& p) { most = std::max(most, (p - content.centre_model_m).norm()); });
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
    if (file.count({'G', 'R', 'I', 'D'}) > 0) {
        content->grid = read_grid(file);
        content->scale = ContourScale(content->grid, content->meta.map_mean, content->meta.map_sigma);
        content->box_min_model_m = content->grid.origin_m;
        for (int axis = 0; axis < 3; ++axis)
            content->box_max_model_m[axis] =
                content->grid.origin_m[axis] +
                content->grid.spacing_m[axis] * (content->grid.size[static_cast<std::size_t>(axis)] - 1.0);
    }
    content->system = system_row(content->meta.kind).read(std::move(file), *content);
    find_extent(*content);
    return content;
}

}  // namespace tact
