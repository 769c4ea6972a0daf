// The space that a body fills, as a field that pushes others out, and the points with which it is
// pushed itself.
//
// Field     (depth / 4 A)^4 at a point, dimensionless, body frame. Depth is the distance to the nearest
//           place where an atom's centre of another body may be: 2.8 A or more from all atoms (two carbons
//           that overlap by 0.6 A, see ipc/scene/fit/clashes.hpp). Zero outside, C2 throughout, never below 0.
// Points    atoms at the surface, some 5 A apart, at most 1024; in runs that lie close together, so that
//           most of them are passed over where only corners of two bodies meet. point_weight: how many
//           points of 5 A spacing one of them stands for.
// Thread    built off the servo thread (0.1 s for 4 000 atoms, 0.6 s for 27 000); then immutable, any thread.
// Fails by  StartupError where the structure has no atoms, or atoms that are nowhere.
#pragma once

#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

class ClashField {
public:
    explicit ClashField(const Structure& structure);

    // Of a run of points, body frame.
    struct Run {
        std::size_t begin, count;
        Vec3 middle_m;
        double radius_m;
    };

    [[nodiscard]] const DensityMap& map() const noexcept { return map_; }
    [[nodiscard]] const PointSet& points() const noexcept { return points_; }
    [[nodiscard]] const std::vector<Run>& runs() const noexcept { return runs_; }
    [[nodiscard]] double point_weight() const noexcept { return point_weight_; }
    // Outside of this box, and of this sphere about the body's origin, the field is zero.
    [[nodiscard]] const Vec3& low_m() const noexcept { return low_m_; }
    [[nodiscard]] const Vec3& high_m() const noexcept { return high_m_; }
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }

    static constexpr double kContactM = 2.8e-10;
    static constexpr double kUnitM = 4e-10;
    static constexpr int kPower = 4;

private:
    struct Made;
    explicit ClashField(Made&& made);
    static Made make(const Structure& structure);

    DensityMap map_;
    PointSet points_;
    std::vector<Run> runs_;
    double point_weight_;
    Vec3 low_m_, high_m_;
    double radius_m_;
};

}  // namespace tact
