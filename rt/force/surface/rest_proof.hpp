// Proof that a ball is at rest: the triangles that it touches bear the pull towards its goal.
//
// Touch    a triangle within kBandMargins of its rest: radius_m over the inside, radius_m - margin_m over an edge or corner.
//          Distance and normal are computed in double precision.
// Solve    the move nearest to the pull that no touched triangle forbids, and the weights of at most three of their normals.
//          At rest (a Karush-Kuhn-Tucker point) this move is zero; else it is the residual.
// Holds    if the true position is at most a margin away: at most the residual over the curvature of the distance
//          to the goal along the surface: 1 on facets, 1 - w / d with the weight w on an edge at distance d. With
//          w > d the goal is nearer on either side of the edge: at rest, but not stable. Curvatures below kStable
//          prove nothing. With friction, the residual may be larger by the coefficient times the lift (Coulomb).
// Unit     metres of the model.  Thread  servo, TACT_RT: no allocation, at most kTouches triangles
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/surface/half_spaces.hpp"

namespace tact {

struct ContactPlane {
    Vec3 normal = Vec3::Zero();  // towards the proxy, unit
    double weight_m = 0.0;       // see Contact
    std::uint32_t triangle = 0;
};

class RestProof {
public:
    static constexpr std::size_t kTouches = 24;
    static constexpr double kBandMargins = 0.5, kFreeMargins = 0.1, kStable = 0.2;
    // Nearest points this close to the border count as over the inside, but need a second triangle of the plane: neither
    // rounding on the border of two triangles nor a place that the least push leaves may decide.
    static constexpr double kBorderMargins = 1e-3;

    struct Touch {
        Vec3 normal = Vec3::Zero();
        Vec3 edge = Vec3::Zero();  // unit, if it touches an edge
        double gap_m = 0.0, distance_m = 0.0, weight_m = 0.0;
        double inset_m = 0.0;  // of a flat touch: at most its distance from the border
        std::uint32_t triangle = 0;
        bool flat = false;    // over the inside
        bool border = false;  // flat, on the border: stable only together with the next triangle of the plane
    };

    void begin(double radius_m, double margin_m) noexcept TACT_RT {
        radius_m_ = radius_m;
        margin_m_ = margin_m;
        count_ = 0;
    }
    // False: no room. A triangle that the ball does not touch is ignored.
    bool add(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& ball_m) noexcept TACT_RT;
    // pull_m: from the ball to its goal.
    void solve(const Vec3& pull_m) noexcept TACT_RT;
    [[nodiscard]] bool holds(double friction) const noexcept TACT_RT;
    // The ball is in no touched triangle, and all of them had room.
    [[nodiscard]] bool is_free() const noexcept TACT_RT {
        return count_ < kTouches &&
               std::all_of(touch_.data(), touch_.data() + count_,
                           [this](const Touch& t) { return t.gap_m >= -kFreeMargins * margin_m_; });
    }

    [[nodiscard]] std::span<const Touch> touches() const noexcept TACT_RT {
        return std::span(touch_).first(count_);
    }
    [[nodiscard]] const Vec3& residual_m() const noexcept TACT_RT { return residual_m_; }
    // Sum of weight_m * normal.
    [[nodiscard]] const Vec3& lift_m() const noexcept TACT_RT { return lift_m_; }
    struct Shape {
        double curvature = 0.0;        // at most 1; 0: not stable
        Vec3 newton_m = Vec3::Zero();  // to the minimum; zero if unknown
    };
    [[nodiscard]] Shape shape() const noexcept TACT_RT;
    // The touched triangle, if it is the only one and touched over its inside; else null.
    [[nodiscard]] const Touch* single_facet() const noexcept TACT_RT {
        return count_ == 1 && touch_[0].flat && !touch_[0].border && touch_[0].weight_m > 0.0 ? touch_.data()
                                                                                              : nullptr;
    }

private:
    [[nodiscard]] bool continued(std::size_t touch) const noexcept TACT_RT;
    double radius_m_ = 0.0, margin_m_ = 0.0;
    std::array<Touch, kTouches> touch_;
    std::size_t count_ = 0;
    Vec3 residual_m_ = Vec3::Zero(), lift_m_ = Vec3::Zero();
};

}  // namespace tact
