#include "gui/docking/docking_content.hpp"

#include <algorithm>

#include "ipc/scene/density/start_place.hpp"

namespace tact {

const NormalModes& DockingContent::modes_of(std::size_t body) const {
    static const NormalModes kNone;
    return body < modes.size() ? modes[body] : kNone;
}

void DockingContent::each_point(const std::function<void(const Vec3&)>& take) const {
    for (std::size_t body = 0; body < bodies.size(); ++body) {
        const Structure& s = bodies[body];
        const Vec3 start_m = start_of(body).p_m;
        for (std::size_t i = 0; i < s.size(); ++i) take(start_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i]));
    }
}

const DockingContent& docking_of(const SceneContent& content) {
    static const DockingContent kNone;
    const DockingContent* const docking = content.of<DockingContent>();
    return docking != nullptr ? *docking : kNone;
}

std::unique_ptr<SystemContent> read_docking(SceneFile file, SceneContent& content) {
    auto docking = std::make_unique<DockingContent>();
    const std::uint32_t bodies = std::min(file.count({'B', 'O', 'D', 'Y'}), content.meta.body_count);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        docking->bodies.push_back(read_structure(file, i));
        docking->codebooks.push_back(i < file.count({'C', 'O', 'D', 'E'}) ? read_codebook(file, i)
                                                                          : Codebook{});
        docking->bonds.push_back(find_bonds(docking->bodies.back()));
        docking->modes.push_back(read_modes(file, i, docking->bodies.back()));
    }
    docking->starts = start_places(content.grid, docking->bodies);
    return docking;
}

}  // namespace tact
