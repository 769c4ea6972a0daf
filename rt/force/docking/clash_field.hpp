// Clash model of a body: a field that repels other bodies, and surface points on which their fields act.
//
// Field     (depth / 4 A)^4 at a point, dimensionless, body frame. Depth is the distance to the nearest
//           position permitted for an atom centre of another body: 2.8 A or more from all atoms (two carbons
//           that overlap by 0.6 A, see ipc/scene/fit/clashes.hpp). Zero outside, C2 throughout, never below 0.
// Points    surface atoms about 5 A apart, at most 1024, in spatially compact runs, so that most runs are skipped
//           where two bodies meet at their edges. point_weight: number of points of 5 A spacing that one point
//           represents.
// Thread    built off the servo thread (0.1 s for 4 000 atoms, 0.6 s for 27 000); then immutable, any thread.
// Fails by  StartupError if the structure has no atoms, or atoms without a finite position.
#pragma once

#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

class ClashField {
public:
    explicit ClashField(const Structure& structure);

    // A run of consecutive points, with its bounding sphere in the body frame.
    struct Run {
        std::size_t begin, count;
        Vec3 middle_m;
        double radius_m;
    };

    [[nodiscard]] const DensityMap& map() const noexcept { return map_; }
    [[nodiscard]] const PointSet& points() const noexcept { return points_; }
    [[nodiscard]] const std::vector<Run>& runs() const noexcept { return runs_; }
    [[nodiscard]] double point_weight() const noexcept { return point_weight_; }
    // The field is zero outside this box and outside this sphere about the body's origin.
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
