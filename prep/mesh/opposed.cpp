#include "prep/mesh/opposed.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "prep/mesh/nearest_point.hpp"

namespace tact {
namespace {

constexpr float kUp = 1.0001F;  // rounds up

Eigen::Vector3d opposed_area(const std::array<Eigen::Vector3d, 3>& c) {
    return (c[1] - c[0]).cross(c[2] - c[0]);
}

// The centre, and the middle between it and each corner.
std::array<Eigen::Vector3d, 4> opposed_points(const std::array<Eigen::Vector3d, 3>& c) {
    const Eigen::Vector3d centre = (c[0] + c[1] + c[2]) / 3.0;
    return {centre, 0.5 * (centre + c[0]), 0.5 * (centre + c[1]), 0.5 * (centre + c[2])};
}

}  // namespace

Opposed::Opposed(const TriangleMesh& original) : original_(original), after_(original.vertices()) {
    std::iota(after_.begin(), after_.end(), 0U);
}

void Opposed::list_triangles() {
    first_.assign(original_.vertices() + 1, 0);
    for (const std::uint32_t v : original_.triangle) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    list_.resize(original_.triangle.size());
    seen_.assign(original_.triangles(), 0);
    spot_.resize(original_.vertices());
    for (std::size_t v = 0; v < spot_.size(); ++v) {
        const float* p = &original_.position_m[3 * v];
        spot_[v] = {{p[0], p[1], p[2]}, 0.0F, Eigen::Vector3f::Zero()};
    }
    std::vector<std::uint32_t> place(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < original_.triangle.size(); ++i) {
        Spot& a = spot_[original_.triangle[i]];
        Spot& b = spot_[original_.triangle[i % 3 == 2 ? i - 2 : i + 1]];
        const float edge = (a.at - b.at).norm();
        a.reach = std::max(a.reach, edge);
        b.reach = std::max(b.reach, edge);
        list_[place[original_.triangle[i]]++] = i / 3;
        if (i % 3 == 0) {
            const Eigen::Vector3f normal = opposed_area(corners(i / 3)).normalized().cast<float>();
            for (std::uint32_t k = i; k < i + 3; ++k) spot_[original_.triangle[k]].mean += normal;
        }
    }
}

template <class Take>
void Opposed::each_in_part(const Face& face, Take&& take) {
    std::uint64_t visits = 0;
    for (const std::uint32_t start : face.vertex) {
        std::uint32_t v = start;
        do {
            ++visits;
            take(v);
            v = after_[v];
        } while (v != start);
    }
    work_ += visits / 4;
}

std::array<Eigen::Vector3d, 3> Opposed::corners(std::uint32_t t) const {
    const std::uint32_t* c = &original_.triangle[3 * std::size_t{t}];
    return {spot_[c[0]].at.cast<double>(), spot_[c[1]].at.cast<double>(), spot_[c[2]].at.cast<double>()};
}

double Opposed::opposed_m(const Face& face, double enough_m) {
    if (first_.empty()) list_triangles();
    const Eigen::Vector3d normal = opposed_area(face.corner);
    const Eigen::Vector3f way = normal.normalized().cast<float>();
    const auto enough = static_cast<float>(enough_m);
    double most = 0.0;
    for (const Eigen::Vector3d& p : opposed_points(face.corner)) {
        // Bounds from the vertices: one whose mean normal faces the triangle's way has a triangle that does.
        const Eigen::Vector3f near = p.cast<float>();
        float any_square = 1e30F, alike_square = 1e30F;
        each_in_part(face, [&](std::uint32_t v) {
            const float square = (spot_[v].at - near).squaredNorm();
            any_square = std::min(any_square, square);
            if (square < alike_square && spot_[v].mean.dot(way) > 0.0F) alike_square = square;
        });
        if (alike_square <= enough * enough) continue;
        ++turn_;
        float any_m = kUp * std::sqrt(any_square), alike_m = kUp * std::sqrt(alike_square);
        double any = 1e300, alike = kNowhere * kNowhere;
        each_in_part(face, [&](std::uint32_t v) {
            const float away = (spot_[v].at - near).squaredNorm(), far = alike_m + spot_[v].reach;
            if (away > far * far) return;
            const bool far_from_any = away > (any_m + spot_[v].reach) * (any_m + spot_[v].reach);
            for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
                if (seen_[list_[i]] == turn_) continue;  // from another of its corners
                ++work_;
                const std::array<Eigen::Vector3d, 3> c = corners(list_[i]);
                const bool along = opposed_area(c).dot(normal) > 0.0;
                if (!along && far_from_any) continue;
                seen_[list_[i]] = turn_;
                const double square = nearest_point(p, c[0], c[1], c[2]).square;
                any = std::min(any, square);
                any_m = std::min(any_m, kUp * static_cast<float>(std::sqrt(square)));
                if (!along || square >= alike) continue;
                alike = square;
                alike_m = std::min(alike_m, kUp * static_cast<float>(std::sqrt(square)));
            }
        });
        if (any < alike) most = std::max(most, std::sqrt(alike) - std::sqrt(any));
    }
    return most;
}

}  // namespace tact
