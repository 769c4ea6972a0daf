#include "prep/mesh/opposed.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "prep/mesh/nearest_point.hpp"

namespace tact {
namespace {

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
        spot_[v] = {{p[0], p[1], p[2]}, 0.0F};
    }
    std::vector<std::uint32_t> place(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < original_.triangle.size(); ++i) {
        Spot& a = spot_[original_.triangle[i]];
        Spot& b = spot_[original_.triangle[i % 3 == 2 ? i - 2 : i + 1]];
        const float edge = (a.at - b.at).norm();
        a.reach = std::max(a.reach, edge);
        b.reach = std::max(b.reach, edge);
        list_[place[original_.triangle[i]]++] = i / 3;
    }
}

// Calls take(vertex of the original) until it returns true.
template <class Take>
void Opposed::each_in_part(const Face& face, Take&& take) const {
    for (const std::uint32_t start : face.vertex) {
        std::uint32_t v = start;
        do {
            if (take(v)) return;
            v = after_[v];
        } while (v != start);
    }
}

std::array<Eigen::Vector3d, 3> Opposed::corners(std::uint32_t t) const {
    const std::uint32_t* c = &original_.triangle[3 * std::size_t{t}];
    return {spot_[c[0]].at.cast<double>(), spot_[c[1]].at.cast<double>(), spot_[c[2]].at.cast<double>()};
}

double Opposed::opposed_m(const Face& face, double enough_m) {
    if (first_.empty()) list_triangles();
    const Eigen::Vector3d normal = opposed_area(face.corner);
    double most = 0.0;
    for (const Eigen::Vector3d& p : opposed_points(face.corner)) {
        ++turn_;
        const Eigen::Vector3f near = p.cast<float>();
        double any = 1e300, alike = kNowhere * kNowhere;
        float any_m = 1e15F, alike_m = 1e15F;  // the roots, rounded up
        each_in_part(face, [&](std::uint32_t v) {
            const float away = (spot_[v].at - near).squaredNorm(), far = alike_m + spot_[v].reach;
            ++work_;
            if (away > far * far) return false;
            const bool far_from_any = away > (any_m + spot_[v].reach) * (any_m + spot_[v].reach);
            for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
                if (seen_[list_[i]] == turn_) continue;  // from another of its corners
                work_ += 4;
                const std::array<Eigen::Vector3d, 3> c = corners(list_[i]);
                const bool along = opposed_area(c).dot(normal) > 0.0;
                if (!along && far_from_any) continue;
                seen_[list_[i]] = turn_;
                const double square = nearest_point(p, c[0], c[1], c[2]).square;
                if (square < any) {
                    any = square;
                    any_m = 1.0001F * static_cast<float>(std::sqrt(square));
                }
                if (along && square < alike) {
                    alike = square;
                    alike_m = 1.0001F * static_cast<float>(std::sqrt(square));
                }
            }
            return alike <= enough_m * enough_m;
        });
        if (any < alike) most = std::max(most, std::sqrt(alike) - std::sqrt(any));
    }
    return most;
}

}  // namespace tact
