// A step of a ball that touches one facet, or none, where no other triangle can be in its way: in closed form, without a
// query. Most steps of a point on a coarse mesh are of this kind.
//
// Clear    The nearest other triangles are in no way while the ball is above their planes (a flat patch, a convex edge). All
//          others are farther than a free path, which set_clear() gets.
// Exact    in double precision and a function of facet, ball and goal alone, so a step that queried the triangles and
//          found the same facet ends at the same position, bit by bit.
// Unit     metres of the model.  Thread  servo, TACT_RT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

class EasyStep {
public:
    static constexpr std::size_t kPlanes = 12;
    static constexpr double kLevel = 1e-9;  // sine of planes that count as one

    struct Move {
        bool known = false;  // false: not over the inside of the facet
        Vec3 to_m = Vec3::Zero();
        Vec3 rub_m = Vec3::Zero();  // from the frictionless position to to_m
        double weight_m = 0.0;      // 0: free
    };

    void forget() noexcept TACT_RT {
        clear_m_ = -1.0;
        has_facet_ = false;
    }
    // The ball is free: the facet remains unless the ball is behind its plane.
    void leave(const Vec3& ball_m) noexcept TACT_RT {
        clear_m_ = -1.0;
        has_facet_ = has_facet_ && normal_.dot(ball_m) - height_ > -band_m_;
    }
    // normal: towards the ball, unit. border_m: nearer to the border, the ball is not over the facet.
    void set_facet(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& normal, double radius_m,
                   double band_m, double border_m) noexcept TACT_RT {
        if (has_facet_ && triangle == triangle_ && normal.dot(normal_) > 0.0) return;
        const auto corner = mesh.corners(triangle);
        const std::array<Vec3, 3> p{mesh.position_m(corner[0]), mesh.position_m(corner[1]),
                                    mesh.position_m(corner[2])};
        const bool turned = (p[1] - p[0]).cross(p[2] - p[0]).dot(normal) < 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 along = p[(k + 1) % 3] - p[k];
            inward_[k] = ((turned ? -1.0 : 1.0) * normal.cross(along)).normalized();
            border_[k] = inward_[k].dot(p[k]) + border_m;
        }
        normal_ = normal;
        height_ = normal.dot(p[0]) + radius_m;
        triangle_ = triangle;
        band_m_ = band_m;
        clear_m_ = -1.0;
        has_facet_ = true;
    }
    // From at_m no triangle but the facet and those of above() is nearer than the radius plus clear_m.
    void set_clear(const Vec3& at_m, double clear_m) noexcept TACT_RT {
        at_m_ = at_m;
        clear_m_ = clear_m;
        planes_ = 0;
    }
    void limit_clear(double clear_m) noexcept TACT_RT { clear_m_ = clear_m; }
    // False: the ball is not so far above the triangle's plane that it cannot touch. sunk_m: this much below is still above.
    bool above(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& ball_m, double radius_m,
               double sunk_m) noexcept TACT_RT {
        const auto corner = mesh.corners(triangle);
        const Vec3 a = mesh.position_m(corner[0]), b = mesh.position_m(corner[1]),
                   c = mesh.position_m(corner[2]);
        Plane& plane = plane_[planes_];
        plane.normal = (b - a).cross(c - a);
        const double length = plane.normal.norm();
        if (!(length > 0.0)) return false;
        plane.normal *= std::copysign(1.0 / length, plane.normal.dot(ball_m - a));
        // Beyond a border of the facet and not tilted towards it: over the facet, the ball is not over the triangle. Its edge is
        // touched a margin below the plane's height only.
        bool beside = false;
        for (std::size_t k = 0; has_facet_ && k < 3; ++k)
            beside |= inward_[k].dot(plane.normal) <= kLevel &&
                      std::max({inward_[k].dot(a), inward_[k].dot(b), inward_[k].dot(c)}) <= border_[k];
        plane.height_m = plane.normal.dot(a) + radius_m + (beside ? -sunk_m : band_m_);
        if (!(plane.normal.dot(ball_m) >= plane.height_m)) return false;
        ++planes_;
        return true;
    }
    // More displacements like this one end on the facet too.
    [[nodiscard]] bool holds(const Vec3& ball_m, const Vec3& moved_m, double times) const noexcept TACT_RT {
        const Vec3 to_m = ball_m + times * moved_m;
        bool holds = true;
        for (std::size_t k = 0; k < 3; ++k) holds &= inward_[k].dot(to_m) > border_[k];
        return holds;
    }
    [[nodiscard]] bool has_facet(std::uint32_t triangle) const noexcept TACT_RT {
        return has_facet_ && triangle == triangle_;
    }
    [[nodiscard]] const Vec3& normal() const noexcept TACT_RT { return normal_; }
    [[nodiscard]] std::uint32_t triangle() const noexcept TACT_RT { return triangle_; }
    [[nodiscard]] bool clear(const Vec3& to_m) const noexcept TACT_RT {
        bool clear = clear_m_ > 0.0 && (to_m - at_m_).squaredNorm() < clear_m_ * clear_m_;
        for (std::size_t i = 0; i < planes_; ++i) clear &= plane_[i].normal.dot(to_m) >= plane_[i].height_m;
        return clear;
    }

    [[nodiscard]] Move move(const Vec3& ball_m, const Vec3& goal_m, double friction) const noexcept TACT_RT {
        Move m;
        m.to_m = goal_m;
        m.known = true;
        if (!has_facet_) return m;
        const double over = normal_.dot(ball_m) - height_, depth = height_ - normal_.dot(goal_m);
        m.known = over > -band_m_;
        if (depth <= 0.0) return m;
        m.weight_m = depth;
        m.to_m += depth * normal_;
        // No friction before contact.
        if (friction > 0.0 && over <= band_m_) {
            Vec3 slide = m.to_m - ball_m;
            slide -= normal_.dot(slide) * normal_;
            const double length = slide.norm(), held = friction * depth;
            m.rub_m = length > held ? Vec3(-held / length * slide) : Vec3(-slide);
            m.to_m += m.rub_m;
        }
        for (std::size_t k = 0; k < 3; ++k) m.known &= inward_[k].dot(m.to_m) > border_[k];
        return m;
    }

private:
    struct Plane {
        Vec3 normal = Vec3::Zero();
        double height_m = 0.0;
    };
    std::array<Plane, kPlanes> plane_;
    std::size_t planes_ = 0;
    bool has_facet_ = false;
    std::uint32_t triangle_ = 0;
    std::array<Vec3, 3> inward_;
    std::array<double, 3> border_{};
    Vec3 normal_ = Vec3::Zero(), at_m_ = Vec3::Zero();
    double height_ = 0.0;  // of the ball's centre at rest, along the normal
    double band_m_ = 0.0, clear_m_ = -1.0;
};

}  // namespace tact
