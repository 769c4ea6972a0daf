// Measures while the loop runs how far the shown, reduced sum was from that over all atoms.
//
// A measurement keeps the pose of one step and its reduced sum, and adds up the atoms there in slices, one a
// step, each at most an eighth of the step's own points (32 at least). So it costs little, its work is known
// before the step, and runs repeat exactly; at 200 vectors and 5000 atoms it takes 160 steps.
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
    // What is being felt is another thing from now on; the measurement under way is dropped.
    void restart() noexcept TACT_RT { running_ = false; }

    // One slice. reduced: the step's own gradient at this pose, bound: what its distance from the exact one
    // should not exceed, points: how many it summed. True: a measurement is complete.
    bool step(const DensityMap& map, const PointSet& atoms, const Pose& T_model_body, const Vec3& reduced,
              double bound, std::size_t points) noexcept TACT_RT {
        if (points >= atoms.size()) {  // it was all atoms; nothing to measure
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
    // Of the last complete measurement.
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
