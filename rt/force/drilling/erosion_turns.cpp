#include "rt/force/drilling/erosion_turns.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

std::uint32_t ErosionTurns::groups_at(float fidelity, double step_s) const noexcept {
    const double level = fidelity >= 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    const double all = groups_;
    const double wanted = std::max(std::round(std::pow(all, level)), std::ceil(all * step_s / kWaitSMost));
    return static_cast<std::uint32_t>(std::min(wanted, all));
}

void ErosionTurns::forget(const Centres& now_voxels) noexcept {
    ++step_;
    for (std::uint32_t g = 0; g < groups_; ++g) group_[g] = {now_voxels, 0.0, step_, {}, false};
    pending_ = walked_ = 0.0;
    sum_ = {};
    started_ = known_ = 0;
}

void ErosionTurns::expose(double exposure, double most) noexcept {
    pending_ = 0.0;
    for (std::uint32_t g = 0; g < groups_; ++g) {
        double& held = group_[g].exposure;
        if (exposure > 0.0 && held < most) held = std::min(held + exposure, most);
        pending_ += held;
    }
}

ErosionTurns::Done ErosionTurns::cut(Erosion& erosion, const Job& job) noexcept {
    Done done;
    if (!(pending_ > 0.0)) {
        forget(*job.now_voxels);
        return done;
    }
    ++step_;
    done.wanted = std::min({job.groups, groups_, started_ + 1});
    while (done.cut < done.wanted) {
        const Group& first = group_[next_];
        std::uint32_t many = 0;
        while (done.cut + many < done.wanted && many < pass_groups() &&
               group_[(next_ + many) % groups_].step == first.step)
            ++many;
        Bricks bricks;
        if (first.exposure > 0.0) {
            if (done.cut > 0 && job.deadline->passed()) break;
            const ErosionPass before = erosion.pass();
            for (std::uint32_t i = 0; i < job.tool->count; ++i) {
                const ToolBall& ball = job.tool->ball[i];
                if (!ball.cuts) continue;
                erosion.cut(*job.kernels, {.from_voxels = first.from_voxels[i],
                                           .to_voxels = (*job.now_voxels)[i],
                                           .radius_voxels = ball.radius_m / job.per_voxel_m,
                                           .exposure = first.exposure * ball.weight,
                                           .soft = job.soft,
                                           .groups = groups_,
                                           .first = next_,
                                           .count = many});
            }
            const ErosionPass& after = erosion.pass();
            bricks = {static_cast<double>(after.visited - before.visited) / many,
                      static_cast<double>(after.bricks - before.bricks) / many};
            walked_ = after.walked - before.walked;
        }
        for (std::uint32_t k = 0; k < many; ++k, next_ = (next_ + 1) % groups_) {
            Group& group = group_[next_];
            pending_ -= group.exposure;
            group.exposure = 0.0;
            group.step = step_;
            sum_.computed += bricks.computed - group.bricks.computed;
            sum_.changed += bricks.changed - group.bricks.changed;
            group.bricks = bricks;
            known_ += group.was_cut ? 0 : 1;
            group.was_cut = true;
            std::copy_n(job.now_voxels->begin(), job.tool->count, group.from_voxels.begin());
        }
        done.cut += many;
    }
    started_ = std::min(done.cut, groups_);
    pending_ = std::max(pending_, 0.0);
    return done;
}

}  // namespace tact
