#include "deploy/tact/place.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/units.hpp"

namespace tact::launch {

Places::Places(const SceneFile& file) : meta_(read_meta(file)), grid_(read_grid(file)) {
    for (std::uint32_t i = 0; i < meta_.body_count; ++i) structures_.push_back(read_structure(file, i));
}

std::optional<std::vector<Pose>> Places::poses(const BodiesTopic& bodies) const {
    if (bodies.count != structures_.size() || bodies.count > kBodiesMax) return std::nullopt;
    std::vector<Pose> all;
    for (std::size_t i = 0; i < structures_.size(); ++i) {
        const BodyPlace& b = bodies.body[i];
        Pose pose{Vec3(b.pos_model_m), Quat(b.quat_model_body_xyzw[3], b.quat_model_body_xyzw[0],
                                            b.quat_model_body_xyzw[1], b.quat_model_body_xyzw[2])};
        if (!pose.finite() || std::abs(pose.q.norm() - 1.0) > 1e-3) return std::nullopt;
        pose.q.normalize();
        all.push_back(pose);
    }
    return all;
}

std::vector<Pose> Places::file_poses() const {
    std::vector<Pose> all;
    std::transform(structures_.begin(), structures_.end(), std::back_inserter(all),
                   [](const Structure& s) { return s.home(); });
    return all;
}

Offset Places::offset(const Pose& T_model_body, std::size_t body) const {
    const Pose home = structures_.at(body).home();
    return {(T_model_body.p_m - home.p_m).norm() / kAngstromM,
            rotation_vector_rad(T_model_body.q * home.q.conjugate()).norm() / kDegreeRad};
}

std::optional<FitMetrics> Places::fit(const std::vector<Pose>& poses) const {
    if (!(meta_.resolution_m > 0.0)) return std::nullopt;
    std::vector<PlacedStructure> placed;
    for (std::size_t i = 0; i < structures_.size(); ++i) placed.push_back({&structures_[i], poses.at(i)});
    return fit_metrics(grid_, placed,
                       {.resolution_m = meta_.resolution_m,
                        .contour = meta_.contour,
                        .background = meta_.map_background,
                        .sigma = meta_.map_sigma});
}

}  // namespace tact::launch
