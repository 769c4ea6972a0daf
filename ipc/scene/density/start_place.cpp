#include "ipc/scene/density/start_place.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr double kGapShare = 0.05;  // of the width of the map

Vec3 width_m(const DensityGrid& grid) {
    return grid.spacing_m.cwiseProduct(Vec3(grid.size[0] - 1.0, grid.size[1] - 1.0, grid.size[2] - 1.0));
}

}  // namespace

double outside_m(const DensityGrid& grid, const Vec3& at_model_m) {
    const Vec3 half_m = 0.5 * width_m(grid);
    return ((at_model_m - grid.origin_m - half_m).cwiseAbs() - half_m).cwiseMax(0.0).norm();
}

bool in_reach(const DensityGrid& grid, const Vec3& at_model_m) {
    return outside_m(grid, at_model_m) <= 0.5 * width_m(grid).maxCoeff();
}

bool overlaps(const DensityGrid& grid, const Structure& structure, const Pose& T_model_body) {
    for (std::size_t i = 0; i < structure.size(); ++i) {
        const Vec3 atom_m = T_model_body * Vec3(structure.x_m[i], structure.y_m[i], structure.z_m[i]);
        if (outside_m(grid, atom_m) == 0.0) return true;
    }
    return false;
}

BodyBall ball_of(const Structure& structure, const Pose& T_model_body) {
    BodyBall ball{T_model_body.p_m, 0.0};
    for (std::size_t i = 0; i < structure.size(); ++i)
        ball.radius_m =
            std::max(ball.radius_m, Vec3(structure.x_m[i], structure.y_m[i], structure.z_m[i]).norm());
    return ball;
}

Pose place_beside(const DensityGrid& grid, const Structure& structure, std::span<const BodyBall> others) {
    const Vec3 width = width_m(grid);
    const double gap_m = kGapShare * width.maxCoeff(), radius_m = ball_of(structure, {}).radius_m;
    Vec3 at_m = grid.origin_m + 0.5 * width;
    at_m.x() += 0.5 * width.x() + gap_m + radius_m;
    // Each body moves it at most once: it only ever moves on, to the far side of one that it touches.
    for (std::size_t pass = 0; pass < others.size(); ++pass)
        for (const BodyBall& other : others)
            if ((at_m - other.centre_model_m).norm() < radius_m + other.radius_m)
                at_m.x() = std::max(at_m.x(), other.centre_model_m.x() + other.radius_m + radius_m + gap_m);
    return {at_m, Quat::Identity()};
}

std::vector<Pose> start_places(const DensityGrid& grid, std::span<const Structure> structures) {
    std::vector<Pose> places;
    std::vector<BodyBall> placed;
    for (const Structure& structure : structures) {
        const bool reached = in_reach(grid, structure.home_com_model_m);
        places.push_back(reached ? structure.home() : place_beside(grid, structure, placed));
        placed.push_back(ball_of(structure, places.back()));
    }
    return places;
}

}  // namespace tact
