#include <algorithm>
#include <cmath>

#include "prep/mesh/contractor.hpp"
#include "prep/mesh/near_pairs.hpp"

namespace tact {
namespace {

constexpr double kBrokenJoints =
    0.05;  // a mesh with more edges of three triangles, as a part of its borders, is broken
constexpr double kBrokenBorders =
    0.1;  // times the boundary weight; 0.3: the largest distance 1.1 times as large

}  // namespace

Contractor::Contractor(const TriangleMesh& mesh, const SimplifySettings& settings)
    : settings_(settings), original_(mesh) {
    scale(mesh);
    touch();
    add_planes();
    add_borders();
    if (settings.locality > 0.0) {
        locality_ = static_cast<float>(settings.locality * settings.locality);
        reach_.assign(vertex_.size(), 0.0F);
    }
}

void Contractor::scale(const TriangleMesh& mesh) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        const Eigen::Vector3d p(mesh.position_m[3 * v], mesh.position_m[3 * v + 1],
                                mesh.position_m[3 * v + 2]);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    if (mesh.vertices() > 0) {
        centre_ = 0.5 * (low + high);
        extent_ = std::max((high - low).maxCoeff(), 1e-30);
    }
    vertex_.resize(mesh.vertices());
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        for (std::size_t i = 0; i < 3; ++i) {
            vertex_[v].p[i] = static_cast<float>(
                (mesh.position_m[3 * v + i] - centre_[static_cast<Eigen::Index>(i)]) / extent_);
        }
    }
    triangle_.resize(mesh.triangles());
    for (std::size_t t = 0; t < triangle_.size(); ++t)
        triangle_[t] = {mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
}

void Contractor::touch() {
    for (const Corners& corners : triangle_) {
        for (const std::uint32_t v : corners) ++vertex_[v].count;
    }
    std::uint32_t first = 0;
    for (Vertex& v : vertex_) {
        v.first = first;
        first += v.count;
        if (v.count > 0) ++alive_;
        v.count = 0;
    }
    // Appended lists may use half of the size again before the lists are compacted.
    touch_limit_ = first + first / 2;
    touch_.reserve(touch_limit_ + 4096);
    touch_.resize(first);
    for (std::uint32_t t = 0; t < triangle_.size(); ++t) {
        for (const std::uint32_t v : triangle_[t]) touch_[vertex_[v].first + vertex_[v].count++] = t;
    }
    for (std::uint32_t v = 0; v < vertex_.size(); ++v) {
        if (vertex_[v].count == 0) vertex_[v].first = v;
    }
    mark_.assign(vertex_.size(), 0);
    hits_.assign(vertex_.size(), 0);
}

void Contractor::add_planes() {
    HugeVector<Eigen::Vector3f> mean(vertex_.size(), Eigen::Vector3f::Zero());
    facing_.assign(vertex_.size(), Eigen::Vector4f::Zero());
    lost_.assign(vertex_.size(), Lost{});
    for (const Corners& c : triangle_) {
        const Eigen::Vector3f normal = double_area(c);
        const float area = normal.norm();
        if (!(area > 0.0F)) continue;
        const Eigen::Vector3f unit = normal * (1.0F / area);
        for (const std::uint32_t v : c) {
            vertex_[v].q.add_plane(unit, 0.5F * area);
            mean[v] += unit;
            facing_[v] += Eigen::Vector4f(normal.x(), normal.y(), normal.z(), area);
        }
    }
    // Initial bound of bend_: twice the largest distance from the mean normal.
    for (Eigen::Vector3f& m : mean) {
        const float length = m.norm();
        m *= length > 0.0F ? 1.0F / length : 0.0F;
    }
    bend_.assign(vertex_.size(), 0);
    for (const Corners& c : triangle_) {
        const Eigen::Vector3f normal = double_area(c);
        const float area = normal.norm();
        const Eigen::Vector3f unit = normal * (area > 0.0F ? 1.0F / area : 0.0F);
        for (const std::uint32_t v : c) {
            const float bend = 255.0F * (unit - mean[v]).norm() + 1.0F;
            bend_[v] = std::max(bend_[v], static_cast<std::uint8_t>(std::min(bend, 255.0F)));
        }
    }
}

// An edge with a number of triangles other than two is a border. In a broken mesh many of them are cracks and flaps, and
// held firmly they would take the vertices that the surface needs: beetle_nonmanifold, where a third of the vertices
// lies on borders, had 1.3 times the largest distance.
void Contractor::add_borders() {
    std::vector<std::array<std::uint32_t, 2>> border;
    std::size_t joints = 0;  // edges of three or more triangles
    for (std::uint32_t u = 0; u < vertex_.size(); ++u) {
        gather(u);
        for (const std::uint32_t w : ring_) {
            if (hits_[w] == 2 || w < u) continue;
            vertex_[u].stamp |= kBorder;
            vertex_[w].stamp |= kBorder;
            border.push_back({u, w});
            if (hits_[w] > 2) ++joints;
        }
    }
    const bool broken = static_cast<double>(joints) > kBrokenJoints * static_cast<double>(border.size());
    const double weight = settings_.boundary_weight * (broken ? kBrokenBorders : 1.0);
    for (const auto& [u, w] : border) add_border(u, w, static_cast<float>(weight));
}

// Adds a plane through the edge, perpendicular to its triangle, which holds the border.
void Contractor::add_border(std::uint32_t u, std::uint32_t w, float boundary_weight) {
    const Eigen::Vector3f edge = vertex_[w].at() - vertex_[u].at();
    for (std::uint32_t i = 0; i < vertex_[u].count; ++i) {
        const Corners& c = triangle_[touch_[vertex_[u].first + i]];
        if (std::find(c.begin(), c.end(), w) == c.end()) continue;
        const Eigen::Vector3f up = double_area(c).cross(edge);
        const float length = up.norm();
        if (!(length > 0.0F)) continue;
        const float weight = boundary_weight * edge.squaredNorm();
        vertex_[u].q.add_plane(up * (1.0F / length), weight);
        vertex_[w].q.add_plane(up * (1.0F / length), weight);
    }
}

// Fills ring_ with the neighbours of u and hits_ with the number of triangles shared with each.
void Contractor::gather(std::uint32_t u) {
    ++epoch_;
    ring_.clear();
    const Vertex& vertex = vertex_[u];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        for (const std::uint32_t w : triangle_[touch_[vertex.first + i]]) {
            if (w == u) continue;
            if (mark_[w] != epoch_) {
                mark_[w] = epoch_;
                hits_[w] = 0;
                ring_.push_back(w);
            }
            ++hits_[w];
        }
    }
}

void Contractor::queue_all(const Progress& progress) {
    for (std::uint32_t u = 0; u < vertex_.size(); ++u) {
        if (u % 4096 == 0) report(progress, 0.1 * u / static_cast<double>(vertex_.size()), "simplify: pairs");
        gather(u);
        for (const std::uint32_t w : ring_) {
            if (w > u) push(u, w);
        }
    }
    if (settings_.pair_distance > 0.0) queue_near();
}

void Contractor::push(std::uint32_t u, std::uint32_t v, std::uint32_t flag) {
    queue_.push(cost(u, v), {u | flag, v, vertex_[u].stamp + vertex_[v].stamp});
}

// Queues pairs without an edge: vertices that are near in space but not connected by an edge.
void Contractor::queue_near() {
    double edges = 0.0, sum = 0.0;
    for (const Corners& c : triangle_) {
        for (std::size_t i = 0; i < 3; ++i) {
            sum += static_cast<double>((vertex_[c[i]].at() - vertex_[c[(i + 1) % 3]].at()).norm());
            edges += 1.0;
        }
    }
    if (!(sum > 0.0)) return;
    std::vector<std::uint32_t> used;
    std::vector<Eigen::Vector3f> at;
    for (std::uint32_t v = 0; v < vertex_.size(); ++v) {
        if (!alive(v)) continue;
        used.push_back(v);
        at.push_back(vertex_[v].at());
    }
    const auto distance = static_cast<float>(settings_.pair_distance * sum / edges);
    // Connected vertices are the nearest of all, so more are requested than are kept.
    near_pairs(at, distance, settings_.pairs_per_vertex_max + 24, [&](std::uint32_t i, const auto& near) {
        const std::uint32_t u = used[i];
        gather(u);
        const std::vector<std::uint32_t> ring = ring_;
        const std::uint32_t first = epoch_;
        for (const std::uint32_t w : ring) {
            for (std::uint32_t k = 0; k < vertex_[w].count; ++k) {
                for (const std::uint32_t x : triangle_[touch_[vertex_[w].first + k]]) mark_[x] = first;
            }
        }
        std::uint32_t kept = 0;
        for (const std::uint32_t j : near) {
            const std::uint32_t w = used[j];
            if (mark_[w] == first || kept == settings_.pairs_per_vertex_max) continue;
            ++kept;
            push(u, w, kNoEdge);
        }
    });
}

}  // namespace tact
