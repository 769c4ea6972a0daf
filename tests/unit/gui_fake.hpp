// A scene and a controller for tests of the visual process: the controller's region is passed over a real link.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"
#include "prep/mesh/progressive.hpp"

namespace tact::fake {

// A helix of C-alpha atoms and its smooth density: small, and quick to bake.
inline Structure helix(std::size_t atoms) {
    Structure s;
    s.name = "helix";
    s.home_com_model_m = Vec3(20e-10, 20e-10, 20e-10);
    s.chain_names = {"A", "B"};
    for (std::size_t i = 0; i < atoms; ++i) {
        const double turn = 100.0 * kDegreeRad * static_cast<double>(i);
        s.x_m.push_back(static_cast<float>(2.3e-10 * std::cos(turn)));
        s.y_m.push_back(static_cast<float>(2.3e-10 * std::sin(turn)));
        s.z_m.push_back(
            static_cast<float>(1.5e-10 * (static_cast<double>(i) - 0.5 * static_cast<double>(atoms - 1))));
        s.mass_fraction.push_back(1.0F / static_cast<float>(atoms));
        s.element.push_back(6);
        s.chain.push_back(i < atoms / 2 ? 0 : 1);
        s.residue.push_back(static_cast<std::int32_t>(i + 1));
        s.trace.push_back(1);
    }
    s.mass_u = 12.0 * static_cast<double>(atoms);
    return s;
}

inline DensityGrid density_of(const Structure& s, std::uint32_t size, double spacing_a, double sigma_a) {
    DensityGrid g;
    g.size = {size, size, size};
    g.spacing_m = Vec3::Constant(spacing_a * kAngstromM);
    g.values.assign(g.count(), 0.0F);
    for (std::uint32_t z = 0; z < size; ++z)
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                const Vec3 p = Vec3(x, y, z).cwiseProduct(g.spacing_m);
                double sum = 0.0;
                for (std::size_t i = 0; i < s.size(); i += 3) {
                    const Vec3 d = p - s.home_com_model_m - Vec3(s.x_m[i], s.y_m[i], s.z_m[i]);
                    sum += std::exp(-0.5 * d.squaredNorm() / (sigma_a * sigma_a * 1e-20));
                }
                g.values[(std::size_t{z} * size + y) * size + x] = static_cast<float>(sum);
            }
    return g;
}

// Writes a scene with one body and one surface. Returns its checksum.
inline std::uint64_t write_helix_scene(const std::filesystem::path& path, std::uint32_t grid = 28) {
    const Structure s = helix(18);
    const DensityGrid g = density_of(s, grid, 40.0 / (grid - 1), 3.0);
    double mean = 0.0, square = 0.0;
    for (const float v : g.values) {
        mean += static_cast<double>(v);
        square += static_cast<double>(v) * static_cast<double>(v);
    }
    mean /= static_cast<double>(g.count());
    SceneMeta meta{};
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 2e7;
    for (double& c : meta.centre_model_m) c = 20e-10;
    meta.energy_j_per_sigma = 0.01;
    meta.map_mean = mean;
    meta.map_sigma = std::sqrt(square / static_cast<double>(g.count()) - mean * mean);
    meta.contour = 0.5;
    meta.resolution_m = 10e-10;
    std::strcpy(meta.title, "helix of the tests");
    Codebook book;
    Codebook::Level level;
    for (std::size_t i = 0; i < s.size(); i += 3) {
        level.x_m.push_back(s.x_m[i]);
        level.y_m.push_back(s.y_m[i]);
        level.z_m.push_back(s.z_m[i]);
        level.weight.push_back(1.0F / 6.0F);
        const auto k = static_cast<std::uint32_t>(level.weight.size() - 1);
        if (k > 0) level.edges.push_back({k - 1, k});
    }
    book.levels.push_back(level);
    SceneWriter out;
    write_meta(out, meta, "map: made by a test\n");
    write_grid(out, g);
    write_structure(out, 0, s);
    write_codebook(out, 0, book);
    write_progressive_mesh(out, 0, isosurface(g, meta.contour));
    out.write(path);
    return SceneFile::open(path).checksum();
}

class Controller {
public:
    Controller(const std::string& session, const std::string& scene_path, std::uint64_t checksum) {
        std::snprintf(region_->scene_path, sizeof region_->scene_path, "%s", scene_path.c_str());
        region_->scene_checksum = checksum;
        region_.mark_ready();
        server_ = std::make_unique<LinkServer>(session, region_.fd());
    }
    // Serves the link. True once a visual process is attached.
    bool serve(int timeout_ms) {
        LinkServer::News news = server_->poll(timeout_ms);
        if (news.gui_left) gui_ = MappedRegion<GuiRegion>();
        if (news.gui_arrived) {
            std::string refusal;
            gui_ = MappedRegion<GuiRegion>::map(std::move(news.gui_fd), refusal);
        }
        return !gui_.empty();
    }
    void publish_level(const char* path, float level, std::uint32_t items, std::uint32_t items_max) {
        LevelsTopic l{};
        l.taken_at_ns = to_ns(Monotonic::now());
        l.sequence = ++levels_sequence_;
        l.goal_hz = 1000.0;
        l.rate_hz = 998.0;
        std::strcpy(l.law, "fixed");
        l.count = 1;
        std::snprintf(l.path[0].path, sizeof l.path[0].path, "%s", path);
        l.path[0].level = level;
        l.path[0].items = items;
        l.path[0].items_max = items_max;
        region_->levels.publish(l);
    }
    [[nodiscard]] std::uint64_t levels_sequence() const { return levels_sequence_; }
    [[nodiscard]] const MappedRegion<GuiRegion>& gui() const { return gui_; }
    RtRegion& region() { return *region_; }

private:
    OwnedRegion<RtRegion> region_;
    std::unique_ptr<LinkServer> server_;
    MappedRegion<GuiRegion> gui_;
    std::uint64_t levels_sequence_ = 0;
};

}  // namespace tact::fake
