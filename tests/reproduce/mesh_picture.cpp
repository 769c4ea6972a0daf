#include "tests/reproduce/mesh_picture.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "deploy/tact/files.hpp"
#include "ipc/image/png.hpp"

namespace tact::launch {
namespace {

constexpr int kSamples = 3;  // per side of a pixel
constexpr double kEdgePx = 0.55;
const Vec3 kFront(0.36, 0.62, 0.85), kBack(0.93, 0.66, 0.38);

Vec3 corner(const TriangleMesh& mesh, std::size_t index) {
    const std::size_t v = std::size_t{3} * mesh.triangle[index];
    return {static_cast<double>(mesh.position_m[v]), static_cast<double>(mesh.position_m[v + 1]),
            static_cast<double>(mesh.position_m[v + 2])};
}

struct Camera {
    Vec3 right, up, toward, centre;
    double px_per_m = 1.0;

    Camera(const TriangleMesh& framed, const Vec3& eye, int width, int height) {
        toward = eye.normalized();
        right = Vec3::UnitZ().cross(toward).normalized();
        up = toward.cross(right);
        Vec3 low = Vec3::Constant(1e300), high = -low;
        for (std::size_t i = 0; i < framed.triangle.size(); ++i) {
            const Vec3 p = turned(corner(framed, i));
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        if (framed.triangle.empty()) low = high = Vec3::Zero();
        const Vec3 size = high - low;
        px_per_m = 0.94 * std::min(width / std::max(size.x(), 1e-30), height / std::max(size.y(), 1e-30));
        centre = 0.5 * (low + high);
    }
    [[nodiscard]] Vec3 turned(const Vec3& p) const { return {right.dot(p), up.dot(p), toward.dot(p)}; }
    // Pixel coordinates: y down, z towards the eye.
    [[nodiscard]] Vec3 at(const Vec3& p, int width, int height) const {
        const Vec3 t = (turned(p) - centre) * px_per_m;
        return {0.5 * width + t.x(), 0.5 * height - t.y(), t.z()};
    }
};

struct Raster {
    int width, height;
    std::vector<float> depth;
    std::vector<std::array<float, 3>> colour;

    Raster(int w, int h)
        : width(w),
          height(h),
          depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h),
                -std::numeric_limits<float>::infinity()),
          colour(depth.size(), {1.0F, 1.0F, 1.0F}) {}

    void triangle(const std::array<Vec3, 3>& p, const Vec3& shade, double edge_px) {
        const double area =
            (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) - (p[2].x() - p[0].x()) * (p[1].y() - p[0].y());
        if (std::abs(area) < 1e-12) return;
        const auto [x_low, x_high] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
        const auto [y_low, y_high] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
        std::array<double, 3> side{};  // length of the edge opposite each corner
        for (std::size_t i = 0; i < 3; ++i) side[i] = (p[(i + 1) % 3] - p[(i + 2) % 3]).head<2>().norm();
        for (int y = std::max(static_cast<int>(y_low), 0);
             y <= std::min(static_cast<int>(y_high), height - 1); ++y)
            for (int x = std::max(static_cast<int>(x_low), 0);
                 x <= std::min(static_cast<int>(x_high), width - 1); ++x) {
                const double px = x + 0.5, py = y + 0.5;
                std::array<double, 3> w{};
                double nearest_px = 1e300;
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const Vec3 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
                    w[i] = ((b.x() - a.x()) * (py - a.y()) - (px - a.x()) * (b.y() - a.y())) / area;
                    inside = inside && w[i] >= 0.0;
                    nearest_px = std::min(nearest_px, w[i] * std::abs(area) / std::max(side[i], 1e-9));
                }
                if (!inside) continue;
                const auto z = static_cast<float>(w[0] * p[0].z() + w[1] * p[1].z() + w[2] * p[2].z());
                const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(x);
                if (z <= depth[at]) continue;
                depth[at] = z;
                const double ink = nearest_px < edge_px ? 0.35 : 1.0;
                for (int i = 0; i < 3; ++i)
                    colour[at][static_cast<std::size_t>(i)] = static_cast<float>(ink * shade[i]);
            }
    }
};

Vec3 shade_of(const Vec3& normal, const Vec3& toward, const Vec3& light) {
    const bool front = normal.dot(toward) >= 0.0;
    const double lit = std::abs(normal.dot(light));
    return (front ? kFront : kBack) * (0.3 + 0.7 * lit);
}

}  // namespace

MeshImage draw_mesh(const TriangleMesh& mesh, const TriangleMesh& framed, const Vec3& eye, bool edges,
                    int width_px, int height_px) {
    const int w = kSamples * width_px, h = kSamples * height_px;
    const Camera camera(framed, eye, w, h);
    const Vec3 light = (camera.toward + 0.5 * camera.up - 0.4 * camera.right).normalized();
    Raster raster(w, h);
    for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
        const std::array<Vec3, 3> at{corner(mesh, t), corner(mesh, t + 1), corner(mesh, t + 2)};
        const Vec3 normal = (at[1] - at[0]).cross(at[2] - at[0]).normalized();
        if (!normal.allFinite()) continue;
        raster.triangle({camera.at(at[0], w, h), camera.at(at[1], w, h), camera.at(at[2], w, h)},
                        shade_of(normal, camera.toward, light), edges ? kEdgePx * kSamples : 0.0);
    }
    MeshImage image{static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px), {}};
    image.rgb.reserve(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
    for (int y = 0; y < height_px; ++y)
        for (int x = 0; x < width_px; ++x) {
            std::array<float, 3> sum{};
            for (int j = 0; j < kSamples; ++j)
                for (int i = 0; i < kSamples; ++i) {
                    const auto& c =
                        raster
                            .colour[static_cast<std::size_t>(kSamples * y + j) * static_cast<std::size_t>(w) +
                                    static_cast<std::size_t>(kSamples * x + i)];
                    for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k];
                }
            for (const float s : sum)
                image.rgb.push_back(static_cast<std::uint8_t>(std::lround(
                    255.0 * std::clamp(static_cast<double>(s) / (kSamples * kSamples), 0.0, 1.0))));
        }
    return image;
}

void save(const MeshPicture& picture, const std::filesystem::path& folder, const std::string& name) {
    const int high = picture.panel_height_px > 0 ? picture.panel_height_px : picture.panel_px;
    nlohmann::json panels = nlohmann::json::array();
    char letter = 'a';
    for (const MeshPanel& p : picture.panels) {
        const MeshImage image =
            draw_mesh(*p.mesh, *picture.panels.front().mesh, picture.eye, p.edges, picture.panel_px, high);
        const std::string file = name + "_" + letter++ + ".png";
        write_png(folder / file, image.width_px, image.height_px, image.rgb);
        panels.push_back({{"file", file}, {"title", p.title}, {"remark", p.remark}});
    }
    const nlohmann::json all{{"title", picture.title}, {"remark", picture.remark}, {"panels", panels}};
    write_whole(folder / (name + ".panels.json"), all.dump(2) + "\n");
}

}  // namespace tact::launch
