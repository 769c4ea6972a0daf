// Measures the error of the reduced sum against the sum over all atoms while the loop runs.
//
// A measurement keeps pose and reduced sum of one step and sums the atoms at that pose in slices, one per step.
// A slice has an eighth of the step's points, at least 32. Its cost is small and known beforehand, and runs
// repeat exactly. With 200 vectors and 5000 atoms a measurement takes 160 steps.
//
// Runs on   servo thread, every step; no allocation
// Frame     gradients in sigma per model metre, model axes
#pragma once

#include <algorithm>
#include <cstddef>

#include "ipc/base/rt.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

class ErrorAudit {
public:
    // Call when map or body changes; drops the measurement in progress.
    void restart() noexcept TACT_RT { running_ = false; }

    // Sums one slice. reduced: gradient of this step at this pose; bound: limit of its error; points: number of
    // points it summed. True: a measurement is complete.
    bool step(const DensityMap& map, const PointSet& atoms, const Pose& T_model_body, const Vec3& reduced,
              double bound, std::size_t points) noexcept TACT_RT {
        if (points >= atoms.size()) {  // the step summed all atoms; nothing to measure
            running_ = false;
            return false;
        }
        if (!running_) {
            running_ = true;
            next_ = 0;
            pose_ = T_model_body;
            reduced_ = reduced;
            bound_ = bound;
            exact_ = Vec3::Zero();
        }
        const std::size_t n = std::min(std::max(points / 8, kSliceMin), atoms.size() - next_);
        exact_ += map.sum(atoms.view(next_, n), pose_).gradient;
        next_ += n;
        running_ = next_ < atoms.size();
        if (running_) return false;
        off_ = (exact_ - reduced_).norm();
        off_bound_ = bound_;
        ++done_;
        return true;
    }
    // Error and bound of the last complete measurement; number of complete measurements.
    [[nodiscard]] double off() const noexcept { return off_; }
    [[nodiscard]] double bound() const noexcept { return off_bound_; }
    [[nodiscard]] std::size_t done() const noexcept { return done_; }

private:
    static constexpr std::size_t kSliceMin = 32;

    bool running_ = false;
    std::size_t next_ = 0, done_ = 0;
    Pose pose_;
    Vec3 reduced_ = Vec3::Zero(), exact_ = Vec3::Zero();
    double bound_ = 0.0;
    double off_ = 0.0, off_bound_ = 0.0;
};

}  // namespace tact
