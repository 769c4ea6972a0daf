#include "gui/docking/molecules.hpp"

#include <algorithm>
#include <cmath>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/fit_colours.hpp"
#include "gui/render/scene_frame.hpp"
#include "gui/render/tube.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr Rgb8 kGhost{150, 156, 168};

// Of triangles with the colours of atoms, closed.
Paint paint_of(const ImpostorView& view) {
    Paint paint{.closed = true};
    if (view.colouring == Colouring::body)
        paint.tint = Eigen::Vector4f(static_cast<float>(view.body[0]) / 255.0F,
                                     static_cast<float>(view.body[1]) / 255.0F,
                                     static_cast<float>(view.body[2]) / 255.0F, 1.0F);
    return paint;
}

}  // namespace

Molecules::Molecules(std::shared_ptr<const SceneContent> content, Programs& programs)
    : content_(std::move(content)),
      programs_(programs),
      structures_(docking_of(*content_).bodies.size()),
      folds_(structures_.size()),
      surfaces_(content_, kSurfaceVertices) {
    for (const Structure& s : docking_of(*content_).bodies)
        grey_.push_back(std::make_shared<const std::vector<Rgb8>>(s.size(), kUnknownFit));
}

void Molecules::set_look(const MoleculeLook& look) {
    look_ = look;
    look_of_.clear();
}

void Molecules::set_look(std::uint32_t id, const MoleculeLook& look) { look_of_[id] = look; }

MoleculeLook Molecules::look(std::uint32_t id) const {
    const auto at = look_of_.find(id);
    return at != look_of_.end() ? at->second : look_;
}

void Molecules::OfStructure::clear() {
    for (TriangleBuffers& t : tube) t.clear();
    for (TriangleBuffers& t : cartoon) t.clear();
    for (ImpostorShapes& t : trace) t.clear();
    sticks.clear();
    spheres.clear();
    surface.clear();
    surface_shape.clear();
}

void Molecules::set_fit_colours(std::uint32_t id, std::vector<Rgb8> colours) {
    fit_paint_[id] = std::make_shared<const std::vector<Rgb8>>(std::move(colours));
}

std::shared_ptr<const std::vector<Rgb8>> Molecules::fit_paint(const DrawnBody& body) const {
    const auto at = fit_paint_.find(body.id);
    const std::shared_ptr<const std::vector<Rgb8>>& grey = grey_[body.structure];
    return at != fit_paint_.end() && at->second->size() == grey->size() ? at->second : grey;
}

Molecules::Source Molecules::source_of(const DrawnBody& body, Colouring colouring) {
    const DockingContent& docking = docking_of(*content_);
    const Structure& straight = docking.bodies[body.structure];
    const std::vector<Bond>& bonds = docking.bonds[body.structure];
    const NormalModes& modes = docking.modes_of(body.structure);
    const bool bends = !body.amplitude_m.empty() && modes.count() >= body.amplitude_m.size();
    if (!bends && colouring != Colouring::fit)
        return {structures_[body.structure], straight, bonds, {}, body.structure};
    Own& own = own_[body.id];
    own.drawn = true;
    const auto paint = colouring == Colouring::fit ? fit_paint(body) : nullptr;
    const std::span<const float> amplitude_m = bends ? body.amplitude_m : std::span<const float>{};
    double apart_2 = 0.0;
    for (std::size_t k = 0; k < amplitude_m.size(); ++k) {
        const double before = k < own.amplitude_m.size() ? static_cast<double>(own.amplitude_m[k]) : 0.0;
        apart_2 += std::pow(static_cast<double>(amplitude_m[k]) - before, 2);
    }
    const bool same = own.atoms.size() == (bends ? straight.size() : 0) &&
                      own.amplitude_m.size() <= amplitude_m.size() && own.paint == paint &&
                      apart_2 < std::pow(kSameShapeA * kAngstromM, 2);
    if (!same) {
        own.amplitude_m.assign(amplitude_m.begin(), amplitude_m.end());
        own.atoms = bends ? bent_structure(straight, modes, amplitude_m) : Structure{};
        own.paint = paint;
        own.made.clear();
    }
    return {own.made, bends ? own.atoms : straight, bonds, paint ? AtomPaint(*paint) : AtomPaint{},
            body.structure};
}

ImpostorShapes& Molecules::shapes(const Source& source, MoleculeStyle style) {
    OfStructure& s = source.made;
    ImpostorShapes& wanted = style == MoleculeStyle::spheres ? s.spheres : s.sticks;
    if (wanted.filled()) return wanted;
    if (style == MoleculeStyle::spheres) {
        std::vector<Sphere> spheres = spheres_of(source.atoms, source.paint);
        order_by_level(spheres);
        wanted.fill(spheres);
    } else {
        std::vector<Stick> sticks = sticks_of(source.atoms, source.bonds, source.paint);
        s.sticks_always = order_by_level(sticks, source.atoms, source.bonds);
        wanted.fill(sticks);
    }
    return wanted;
}

ImpostorShapes& Molecules::trace(const Source& source, std::size_t atoms_per_point) {
    ImpostorShapes& wanted = source.made.trace[atoms_per_point - 1];
    if (!wanted.filled()) wanted.fill(trace_of(source.atoms, atoms_per_point, source.paint));
    return wanted;
}

TriangleBuffers& Molecules::tube(const Source& source, MoleculeStyle style, std::size_t step) {
    OfStructure& s = source.made;
    const bool cartoon = style == MoleculeStyle::cartoon;
    TriangleBuffers& wanted = cartoon ? s.cartoon[step] : s.tube[step];
    if (wanted.indices() > 0) return wanted;
    std::size_t& at_full = cartoon ? s.cartoon_vertices : s.tube_vertices;
    const std::size_t most =
        step == 0 ? (cartoon ? kCartoonVertices : kTubeVertices) / structures_.size() : at_full;
    const auto share =
        static_cast<std::size_t>(static_cast<double>(kTubeLevels[step]) * static_cast<double>(most));
    auto& folds = folds_[source.structure];
    if (cartoon && folds.empty()) folds = folds_of(docking_of(*content_).bodies[source.structure]);
    const TubeMesh mesh = cartoon ? build_ribbons(source.atoms, folds, share, source.paint)
                                  : build_tubes(source.atoms, share, source.paint);
    if (step == 0) at_full = mesh.vertex.size();
    wanted.fill(mesh, GL_STATIC_DRAW);
    return wanted;
}

void Molecules::draw(std::span<const DrawnBody> bodies, const Eigen::Matrix4f& eye_from_scene,
                     const Eigen::Matrix4f& projection, const Haze& haze) {
    left_out_ = 0;
    triangles_ = triangles_max_ = 0;
    std::size_t room = shapes_max_, surface_room = surface_vertices_max_;
    surfaces_.follow();
    surfaces_awaited_ = surfaces_coarse_ = 0;
    // Each has the same share of the vertices, and what those before it left.
    auto surfaces_left =
        static_cast<std::size_t>(std::count_if(bodies.begin(), bodies.end(), [this](const DrawnBody& b) {
            return !b.hidden && !b.ghost && b.structure < structures_.size() &&
                   look(b.id).style == MoleculeStyle::surface;
        }));
    for (auto& [id, own] : own_) own.drawn = false;
    for (const DrawnBody& body : bodies) {
        if (body.hidden || body.structure >= structures_.size()) continue;
        const MoleculeLook l =
            body.ghost ? MoleculeLook{MoleculeStyle::trace, Colouring::body} : look(body.id);
        const ImpostorView view{eye_from_scene * scene_from_body(body.T_model_body, content_->centre_model_m),
                                projection, haze, l.colouring, body.ghost ? kGhost : chain_colour(body.id)};
        const Source source = source_of(body, l.colouring);
        if (l.style == MoleculeStyle::tube || l.style == MoleculeStyle::cartoon) {
            draw_tube(source, l.style, view);
            continue;
        }
        if (l.style == MoleculeStyle::surface) {
            const std::size_t drawn_vertices = draw_surface(source, view, surface_room / surfaces_left--);
            surface_room -= drawn_vertices;
            if (drawn_vertices == 0) draw_tube(source, MoleculeStyle::tube, view);
            continue;
        }
        // Decided by the number of atoms, before any shapes are made.
        const std::size_t atoms = source.atoms.size();
        const std::size_t shapes_drawn = l.style == MoleculeStyle::trace ? 0 : atoms;
        if (shapes_drawn > room) {
            ++left_out_;
            draw_tube(source, MoleculeStyle::tube, view);
            continue;
        }
        room -= shapes_drawn;
        draw_shapes(source, l.style, view);
    }
    std::erase_if(own_, [](const auto& entry) { return !entry.second.drawn; });
}

void Molecules::count(std::size_t drawn, std::size_t most) {
    triangles_ += static_cast<std::uint32_t>(drawn);
    triangles_max_ += static_cast<std::uint32_t>(most);
}

void Molecules::draw_shapes(const Source& source, MoleculeStyle style, ImpostorView view) {
    if (!impostors_) impostors_ = std::make_unique<ImpostorPrograms>();
    constexpr std::size_t kTrianglesOfShape = 2;
    const auto part = static_cast<double>(std::clamp(level_, 0.01F, 1.0F));
    glDisable(GL_CULL_FACE);
    if (style == MoleculeStyle::trace) {
        const std::size_t most = trace(source, 1).count();
        ImpostorShapes& wanted =
            trace(source, std::clamp<std::size_t>(std::lround(1.0 / part), 1, kTraceSteps));
        impostors_->use_sticks(view);
        wanted.draw(wanted.count());
        return count(kTrianglesOfShape * wanted.count(), kTrianglesOfShape * most);
    }
    ImpostorShapes& all = shapes(source, style);
    auto drawn = static_cast<std::size_t>(std::ceil(part * static_cast<double>(all.count())));
    if (style == MoleculeStyle::spheres) {
        view.grow = static_cast<float>(std::cbrt(static_cast<double>(all.count()) /
                                                 static_cast<double>(std::max<std::size_t>(drawn, 1))));
        impostors_->use_spheres(view);
    } else {
        drawn = std::clamp(drawn, source.made.sticks_always, all.count());
        impostors_->use_sticks(view);
    }
    all.draw(drawn);
    count(kTrianglesOfShape * drawn, kTrianglesOfShape * all.count());
}

PaintedSurface& Molecules::surface(const Source& source, const std::shared_ptr<const MolecularSurface>& mesh,
                                   bool by_element) {
    const std::pair key{mesh, by_element};
    const auto at = source.made.surface.find(key);
    if (at != source.made.surface.end()) return at->second;
    // The shape of a body that is straight is that of its structure, whatever its colours.
    const Structure& straight = docking_of(*content_).bodies[source.structure];
    const bool bent = &source.atoms != &straight;
    std::shared_ptr<SurfaceShape>& shape =
        (bent ? source.made : structures_[source.structure]).surface_shape[mesh];
    if (!shape)
        shape = bent
                    ? std::make_shared<SurfaceShape>(bent_surface(*mesh, straight, source.atoms), mesh->index)
                    : std::make_shared<SurfaceShape>(mesh->vertex, mesh->index);
    return source.made.surface
        .try_emplace(key, shape, surface_colours(*mesh, straight, by_element, source.paint))
        .first->second;
}

std::size_t Molecules::draw_surface(const Source& source, const ImpostorView& view,
                                    std::size_t vertices_most) {
    const SurfaceChoice choice = surfaces_.choose(source.structure, level_, vertices_most);
    if (choice.awaited) ++surfaces_awaited_;
    if (!choice.surface) {
        if (choice.too_large) ++left_out_;
        return 0;
    }
    if (choice.too_large) ++surfaces_coarse_;
    PaintedSurface& painted = surface(source, choice.surface, view.colouring == Colouring::element);
    count(choice.surface->index.size() / 3, choice.triangles_most);
    programs_.use_lit(view.eye_from_local, view.projection, view.haze, paint_of(view));
    if (!(view.haze.cut_a > 0.0F)) glEnable(GL_CULL_FACE);  // it is closed
    painted.draw();
    glDisable(GL_CULL_FACE);
    return choice.surface->vertex.size();
}

void Molecules::draw_tube(const Source& source, MoleculeStyle style, const ImpostorView& view) {
    std::size_t step = 0;
    while (step + 1 < kTubeLevels.size() && kTubeLevels[step] > 1.001F * level_) ++step;
    const TriangleBuffers& full = tube(source, style, 0);  // first: the others are parts of it
    TriangleBuffers& tubes = tube(source, style, step);
    count(static_cast<std::size_t>(tubes.indices()) / 3, static_cast<std::size_t>(full.indices()) / 3);
    programs_.use_lit(view.eye_from_local, view.projection, view.haze, paint_of(view));
    if (!(view.haze.cut_a > 0.0F)) glEnable(GL_CULL_FACE);  // tubes are closed
    tubes.draw();
    glDisable(GL_CULL_FACE);
}

}  // namespace tact
