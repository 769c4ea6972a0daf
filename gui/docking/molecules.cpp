#include "gui/docking/molecules.hpp"

#include <algorithm>
#include <cmath>

#include "gui/docking/docking_content.hpp"
#include "gui/render/scene_frame.hpp"
#include "gui/render/tube.hpp"

namespace tact {
namespace {

constexpr Rgb8 kGhost{150, 156, 168};

}  // namespace

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
    ImpostorShapes& wanted = style == MoleculeStyle::spheres ? s.spheres : s.sticks;
    if (wanted.filled()) return wanted;
    if (style == MoleculeStyle::spheres) {
        std::vector<Sphere> spheres = spheres_of(atoms);
        order_by_level(spheres);
        wanted.fill(spheres);
    } else {
        const std::vector<Bond>& bonds = docking_of(*content_).bonds[structure];
        std::vector<Stick> sticks = sticks_of(atoms, bonds);
        s.sticks_always = order_by_level(sticks, atoms, bonds);
        wanted.fill(sticks);
    }
    return wanted;
}

ImpostorShapes& Molecules::trace(std::size_t structure, std::size_t atoms_per_point) {
    ImpostorShapes& wanted = structures_[structure].trace[atoms_per_point - 1];
    if (!wanted.filled()) wanted.fill(trace_of(docking_of(*content_).bodies[structure], atoms_per_point));
    return wanted;
}

TriangleBuffers& Molecules::tube(std::size_t structure, std::size_t step) {
    OfStructure& s = structures_[structure];
    TriangleBuffers& wanted = s.tube[step];
    if (wanted.indices() > 0) return wanted;
    const std::size_t most = step == 0 ? kTubeVertices / structures_.size() : s.tube_vertices;
    const TubeMesh mesh = build_tubes(
        docking_of(*content_).bodies[structure],
        static_cast<std::size_t>(static_cast<double>(kTubeLevels[step]) * static_cast<double>(most)));
    if (step == 0) s.tube_vertices = mesh.vertex.size();
    wanted.fill(mesh, GL_STATIC_DRAW);
    return wanted;
}

void Molecules::draw(std::span<const DrawnBody> bodies, const Eigen::Matrix4f& eye_from_scene,
                     const Eigen::Matrix4f& projection, const Haze& haze) {
    left_out_ = 0;
    triangles_ = triangles_max_ = 0;
    std::size_t room = shapes_max_;
    for (const DrawnBody& body : bodies) {
        if (body.hidden || body.structure >= structures_.size()) continue;
        const MoleculeLook l =
            body.ghost ? MoleculeLook{MoleculeStyle::trace, Colouring::body} : look(body.id);
        const ImpostorView view{eye_from_scene * scene_from_body(body.T_model_body, content_->centre_model_m),
                                projection, haze, l.colouring, body.ghost ? kGhost : chain_colour(body.id)};
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
        draw_shapes(body.structure, l.style, view);
    }
}

void Molecules::count(std::size_t drawn, std::size_t most) {
    triangles_ += static_cast<std::uint32_t>(drawn);
    triangles_max_ += static_cast<std::uint32_t>(most);
}

void Molecules::draw_shapes(std::size_t structure, MoleculeStyle style, ImpostorView view) {
    if (!impostors_) impostors_ = std::make_unique<ImpostorPrograms>();
    constexpr std::size_t kTrianglesOfShape = 2;
    const auto part = static_cast<double>(std::clamp(level_, 0.01F, 1.0F));
    glDisable(GL_CULL_FACE);
    if (style == MoleculeStyle::trace) {
        const std::size_t most = trace(structure, 1).count();
        ImpostorShapes& wanted =
            trace(structure, std::clamp<std::size_t>(std::lround(1.0 / part), 1, kTraceSteps));
        impostors_->use_sticks(view);
        wanted.draw(wanted.count());
        return count(kTrianglesOfShape * wanted.count(), kTrianglesOfShape * most);
    }
    ImpostorShapes& all = shapes(structure, style);
    auto drawn = static_cast<std::size_t>(std::ceil(part * static_cast<double>(all.count())));
    if (style == MoleculeStyle::spheres) {
        view.grow = static_cast<float>(std::cbrt(static_cast<double>(all.count()) /
                                                 static_cast<double>(std::max<std::size_t>(drawn, 1))));
        impostors_->use_spheres(view);
    } else {
        drawn = std::clamp(drawn, structures_[structure].sticks_always, all.count());
        impostors_->use_sticks(view);
    }
    all.draw(drawn);
    count(kTrianglesOfShape * drawn, kTrianglesOfShape * all.count());
}

void Molecules::draw_tube(std::size_t structure, const ImpostorView& view) {
    std::size_t step = 0;
    while (step + 1 < kTubeLevels.size() && kTubeLevels[step] > 1.001F * level_) ++step;
    const TriangleBuffers& full = tube(structure, 0);  // first: the others are parts of it
    TriangleBuffers& tubes = tube(structure, step);
    count(static_cast<std::size_t>(tubes.indices()) / 3, static_cast<std::size_t>(full.indices()) / 3);
    Paint paint;
    if (view.colouring == Colouring::body)
        paint.tint = Eigen::Vector4f(static_cast<float>(view.body[0]) / 255.0F,
                                     static_cast<float>(view.body[1]) / 255.0F,
                                     static_cast<float>(view.body[2]) / 255.0F, 1.0F);
    programs_.use_lit(view.eye_from_local, view.projection, view.haze, paint);
    glEnable(GL_CULL_FACE);  // tubes are closed
    tubes.draw();
    glDisable(GL_CULL_FACE);
}

}  // namespace tact
