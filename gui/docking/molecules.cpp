#include "gui/docking/molecules.hpp"

#include "gui/docking/docking_content.hpp"

#include "gui/render/scene_frame.hpp"
#include "gui/render/tube.hpp"

namespace tact {

Molecules::Molecules(std::shared_ptr<const SceneContent> content, Programs& programs)
    : content_(std::move(content)), programs_(programs), structures_(docking_of(*content_).bodies.size()) {}

void Molecules::set_look(const MoleculeLook& look) {
    look_ = look;
    look_of_.clear();
}

void Molecules::set_look(std::uint32_t id, const MoleculeLook& look) { look_of_[id] = look; }

MoleculeLook Molecules::look(std::uint32_t id) const {
    const auto at = look_of_.find(id);
    return at != look_of_.end() ? at->second : look_;
}

ImpostorShapes& Molecules::shapes(std::size_t structure, MoleculeStyle style) {
    OfStructure& s = structures_[structure];
    const Structure& atoms = docking_of(*content_).bodies[structure];
    ImpostorShapes& wanted = style == MoleculeStyle::spheres  ? s.spheres
                             : style == MoleculeStyle::sticks ? s.sticks
                                                              : s.trace;
    if (wanted.filled()) return wanted;
    if (style == MoleculeStyle::spheres)
        wanted.fill(spheres_of(atoms));
    else if (style == MoleculeStyle::sticks)
        wanted.fill(sticks_of(atoms, docking_of(*content_).bonds[structure]));
    else
        wanted.fill(trace_of(atoms));
    return wanted;
}

void Molecules::draw(std::span<const DrawnBody> bodies, const Eigen::Matrix4f& eye_from_scene,
                     const Eigen::Matrix4f& projection, const Haze& haze) {
    left_out_ = 0;
    std::size_t room = shapes_max_;
    for (const DrawnBody& body : bodies) {
        if (body.hidden || body.structure >= structures_.size()) continue;
        const MoleculeLook l = look(body.id);
        const ImpostorView view{eye_from_scene * scene_from_body(body.T_model_body, content_->centre_model_m),
                                projection, haze, l.colouring, chain_colour(body.id)};
        if (l.style == MoleculeStyle::tube) {
            draw_tube(body.structure, view);
            continue;
        }
        // Decided by the number of atoms, before any shapes are made.
        const std::size_t atoms = docking_of(*content_).bodies[body.structure].size();
        const std::size_t shapes_drawn = l.style == MoleculeStyle::trace ? 0 : atoms;
        if (shapes_drawn > room) {
            ++left_out_;
            draw_tube(body.structure, view);
            continue;
        }
        room -= shapes_drawn;
        ImpostorShapes& wanted = shapes(body.structure, l.style);
        if (!impostors_) impostors_ = std::make_unique<ImpostorPrograms>();
        if (l.style == MoleculeStyle::spheres)
            impostors_->use_spheres(view);
        else
            impostors_->use_sticks(view);
        glDisable(GL_CULL_FACE);
        wanted.draw();
    }
}

void Molecules::draw_tube(std::size_t structure, const ImpostorView& view) {
    TriangleBuffers& tube = structures_[structure].tube;
    if (tube.indices() == 0)
        tube.fill(build_tubes(docking_of(*content_).bodies[structure], kTubeVertices / structures_.size()),
                  GL_STATIC_DRAW);
    Paint paint;
    if (view.colouring == Colouring::body)
        paint.tint = Eigen::Vector4f(static_cast<float>(view.body[0]) / 255.0F,
                                     static_cast<float>(view.body[1]) / 255.0F,
                                     static_cast<float>(view.body[2]) / 255.0F, 1.0F);
    programs_.use_lit(view.eye_from_local, view.projection, view.haze, paint);
    glEnable(GL_CULL_FACE);  // tubes are closed
    tube.draw();
    glDisable(GL_CULL_FACE);
}

}  // namespace tact
