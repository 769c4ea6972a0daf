#include "deploy/tact/docking/places.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "ipc/base/units.hpp"

namespace tact::launch {

Places::Places(const SceneFile& file) : meta_(read_meta(file)), grid_(read_grid(file)) {
    for (std::uint32_t i = 0; i < meta_.body_count; ++i) {
        structures_.push_back(read_structure(file, i));
        modes_.push_back(read_modes(file, i, structures_.back()));
    }
}

std::optional<std::vector<BodyAt>> Places::bodies(const BodiesTopic& topic, const ShapesTopic* shapes) const {
    if (topic.count > kBodiesMax) return std::nullopt;
    std::vector<BodyAt> all;
    for (std::uint32_t i = 0; i < topic.count; ++i) {
        const BodyPlace& b = topic.body[i];
        BodyAt body{.id = b.id,
                    .structure = b.structure,
                    .T_model_body = {Vec3(b.pos_model_m), Quat(b.quat_model_body_xyzw)},
                    .fixed = (b.flags & kBodyFixed) != 0,
                    .in_hand = i == topic.active};
        Quat& q = body.T_model_body.q;
        if (b.structure >= structures_.size() || !body.T_model_body.finite() ||
            std::abs(q.norm() - 1.0) > 1e-3)
            return std::nullopt;
        q.normalize();
        if (shapes != nullptr) {
            const std::span<const float> bent = amplitudes_of(*shapes, b.id);
            body.amplitude_m.assign(bent.begin(), bent.end());
            const bool sound =
                std::all_of(bent.begin(), bent.end(), [](float a) { return std::abs(a) < 1e-6F; });
            if (!sound || bent.size() > modes_[b.structure].count()) return std::nullopt;
        }
        all.push_back(body);
    }
    return all;
}

std::vector<BodyAt> Places::file_bodies() const {
    std::vector<BodyAt> all;
    for (std::uint32_t i = 0; i < structures_.size(); ++i)
        all.push_back({.structure = i, .T_model_body = structures_[i].home()});
    return all;
}

Offset Places::offset(const BodyAt& body) const {
    const Pose home = structures_.at(body.structure).home();
    return {(body.T_model_body.p_m - home.p_m).norm() / kAngstromM,
            rotation_vector_rad(body.T_model_body.q * home.q.conjugate()).norm() / kDegreeRad};
}

FitMetrics Places::fit(const std::vector<BodyAt>& bodies) const {
    std::vector<Structure> shaped;
    for (const BodyAt& b : bodies)
        shaped.push_back(bent_structure(structures_.at(b.structure), modes_.at(b.structure), b.amplitude_m));
    std::vector<PlacedStructure> placed;
    for (std::size_t i = 0; i < bodies.size(); ++i) placed.push_back({&shaped[i], bodies[i].T_model_body});
    return fit_metrics(grid_, placed,
                       {.resolution_m = meta_.resolution_m,
                        .contour = meta_.contour,
                        .background = meta_.map_background,
                        .sigma = meta_.map_sigma});
}

}  // namespace tact::launch
