#include "gui/docking/docking_system.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "gui/docking/body_pick.hpp"
#include "gui/docking/contour_rows.hpp"
#include "gui/docking/docking_content.hpp"
#include "gui/docking/fit_colours.hpp"
#include "gui/link/region_checks.hpp"

namespace tact {
namespace {

// Limit of atoms or bonds drawn as impostors on a software renderer: more take longer than a frame may
// (tests/bench/draw_bench.cpp).
// In software rendering. A view at rest is drawn once, so it may take longer.
constexpr std::size_t kShapesMaxInSoftware = 8000, kShapesMaxAtRest = 60000;
// Vertices of surfaces likewise.
constexpr std::size_t kSurfaceMaxInSoftware = 60000, kSurfaceMaxAtRest = 600000;

constexpr std::int64_t kMessageShown_ns = 12'000'000'000;

DockingSummary summary_of(const SceneContent& content) {
    const SceneMeta& meta = content.meta;
    DockingSummary s{.resolution_m = meta.resolution_m, .voxels = content.grid.size};
    for (const Structure& structure : docking_of(content).bodies) {
        ++s.bodies;
        s.atoms += structure.size();
    }
    return s;
}

}  // namespace

void DockingSystem::use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
                        SceneView& view, const SystemContext& context) {
    static_cast<void>(start);
    content_ = content;
    view_ = &view;
    layer_ = std::make_unique<DockingLayer>(content, view.programs());
    view.set_layer(layer_.get());
    if (!options_.empty()) view.contours().set(contours_of(options_, content->scale));
    begin_contours(view.contours(), content->scale, panels_.contours);
    panels_.scene = summary_of(*content);
    count_contour();
    std::vector<Pose> homes;
    const DockingContent& docking = docking_of(*content);
    for (std::size_t body = 0; body < docking.bodies.size(); ++body) homes.push_back(docking.start_of(body));
    list_.start(homes);
    if (context.controller.have_bodies) list_.follow(context.controller.bodies);
    fit_controller_.use(content);
    coloured_by_ = 0;
}

void DockingSystem::close() {
    if (view_ != nullptr) view_->set_layer(nullptr);
    view_ = nullptr;
    layer_.reset();
    content_.reset();
    list_.start({});
    fit_controller_.use(nullptr);
}

void DockingSystem::attach(const SystemContext& context) {
    static_cast<void>(context);
    list_.forget_motion();
}

void DockingSystem::read(const Controller::Fresh& fresh, const SystemContext& context) {
    if (fresh.bodies) list_.follow(context.controller.bodies);
    if (fresh.shapes) list_.follow(context.controller.shapes);
}

bool DockingSystem::perform(KeyAction what, std::size_t place, const SystemContext& context) {
    const auto active = list_.active();
    const std::uint32_t held = active ? list_.bodies()[*active].id : 0;
    const auto fit = [&](FitAction request) { panels_.fitting.requests.push_back({request, held, {}}); };
    const auto select = [&](std::uint32_t body) {
        context.state.requests.push_back({CommandKind::select_body, 0.0, {}, body});
    };
    switch (what) {
        case KeyAction::raise_contour:
            turn_wheel(1.0);
            return true;
        case KeyAction::lower_contour:
            turn_wheel(-1.0);
            return true;
        case KeyAction::take_body:
            if (place < list_.bodies().size() && context.controller.attached())
                select(list_.bodies()[place].id);
            return true;
        case KeyAction::let_go:
            if (context.controller.attached()) select(kNoBody);
            return true;
        case KeyAction::undo:
            if (!panels_.fitting.can_undo && context.state.added.can_take_back)
                context.state.added.take_back_wanted = true;
            else
                fit(FitAction::undo);
            return true;
        case KeyAction::redo:
            if (!panels_.fitting.can_redo && context.state.added.can_add_again)
                context.state.added.add_again_wanted = true;
            else
                fit(FitAction::redo);
            return true;
        case KeyAction::refine:
            if (held != 0) fit(FitAction::refine);
            return true;
        case KeyAction::accept:
            fit(FitAction::accept);
            context.state.added = {};  // undo goes back no farther
            return true;
        case KeyAction::revert:
            fit(FitAction::revert);
            return true;
        default:
            return false;
    }
}

void DockingSystem::click(const Sight& sight, const SystemContext& context) {
    if (!content_ || !context.state.commands()) return;
    const auto body = body_along(sight, list_.bodies(), docking_of(*content_).bodies);
    if (!body || list_.active() == body) return;
    context.state.requests.push_back({CommandKind::select_body, 0.0, {}, list_.bodies()[*body].id});
}

void DockingSystem::turn_wheel(double steps) {
    if (content_) nudge_contour(panels_.contours, content_->scale, steps);
}

void DockingSystem::choose_by_wheel(double steps) { choose_contour(panels_.contours, steps > 0.0 ? -1 : 1); }

// The body in the hand, wherever the hand holds it.
std::optional<Vec3> DockingSystem::tool_at(std::size_t hand, const SystemContext& context) const {
    static_cast<void>(context);
    const auto active = list_.active();
    return hand == 0 && active ? std::optional(list_.bodies()[*active].T_model_body.p_m) : std::nullopt;
}

void DockingSystem::adapt() {
    if (view_ != nullptr) follow_contours(view_->contours(), content_->scale, panels_.contours);
}

void DockingSystem::count_contour() {
    const SceneMeta& meta = content_->meta;
    panels_.scene.contour = panels_.contours.counting(meta.contour);
    panels_.scene.contour_sigma = (panels_.scene.contour - meta.map_mean) / meta.map_sigma;
}

void DockingSystem::follow_bodies(std::int64_t now_ns, const SystemContext& context) {
    list_.predict(now_ns);
    const BodiesTopic* const topic = context.controller.attached() && context.controller.have_bodies
                                         ? &context.controller.bodies
                                         : nullptr;
    FittingState& fitting = panels_.fitting;
    std::vector<Command> commands;
    for (const auto& [id, hidden] : fitting.hide_requests) list_.set_hidden(id, hidden);
    for (const FitRequest& request : fitting.requests) fit_controller_.perform(request, list_, commands);
    fitting.hide_requests.clear();
    fitting.requests.clear();
    if (content_) count_contour();
    const bool by_fit = context.state.toggles.colouring == static_cast<int>(Colouring::fit);
    fit_controller_.follow(list_, topic, panels_.scene.contour, by_fit, commands);
    if (topic != nullptr)
        for (const Command& command : commands) context.commands.send(command, now_ns);
    fit_controller_.describe(list_, topic, fitting, panels_.fit);
    describe_shape(context.controller, fitting);
    // The list of bodies may be longer than its card, with the message below its edge.
    if (fitting.message != message_) {
        message_ = fitting.message;
        panels_.message_until_ns = now_ns + kMessageShown_ns;
    }
}

void DockingSystem::describe_shape(const Controller& controller, FittingState& fitting) const {
    const auto active = list_.active();
    const DockingContent* const docking = content_ ? &docking_of(*content_) : nullptr;
    fitting.can_bend =
        docking != nullptr && active && docking->modes_of(list_.bodies()[*active].structure).count() > 0;
    const bool known = controller.attached() && controller.have_shapes && active;
    fitting.bent_rmsd_m = known ? static_cast<double>(controller.shapes.rmsd_m) : 0.0;
    fitting.strain = known ? static_cast<double>(controller.shapes.strain) : 0.0;
    fitting.bends = known && controller.shapes.bends != 0;
    fitting.strain_most = known ? static_cast<double>(controller.shapes.strain_most) : 0.0;
}

void DockingSystem::prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) {
    follow_bodies(now_ns, context);
    drawn_.clear();
    for (const ShownBody& b : list_.bodies())
        drawn_.push_back({.T_model_body = b.T_model_body,
                          .structure = b.structure,
                          .id = b.id,
                          .hidden = b.hidden,
                          .amplitude_m = b.amplitude_m});
    if (panels_.fitting.search.ghosts)
        for (const DrawnBody& ghost : fit_controller_.finder().ghosts(list_)) drawn_.push_back(ghost);
    if (const auto active = list_.active()) frame.force_at_model_m = drawn_[*active].T_model_body.p_m;
    const SceneToggles& t = context.state.toggles;
    const Controller& c = context.controller;
    const PathLevel* const force = c.have_levels ? find_path(c.levels, kDockingPath) : nullptr;
    layer_->frame = {t.backbone, t.codebook, t.graph, drawn_, force != nullptr ? force->items : 0};
    if (const PathLevel* const path = c.level(kMoleculesPath)) molecules_level_ = path->level;
    layer_->molecules().set_level(sharp ? 1.0F : molecules_level_);
    if (context.software) {
        layer_->molecules().set_shapes_max(sharp ? kShapesMaxAtRest : kShapesMaxInSoftware);
        layer_->molecules().set_surface_vertices_max(sharp ? kSurfaceMaxAtRest : kSurfaceMaxInSoftware);
    }
    label(frame, context);
    colour_by_fit();
    layer_->molecules().set_look(
        {static_cast<MoleculeStyle>(t.molecule), static_cast<Colouring>(t.colouring)});
}

void DockingSystem::label(const ViewFrame& frame, const SystemContext& context) {
    const SceneToggles& t = context.state.toggles;
    const auto kind = static_cast<LabelKind>(t.labels);
    const bool one_view =
        context.state.stage.empty() && t.backbone;  // each eye of a stereo display has its own
    panels_.labels.clear();
    if (kind == LabelKind::none || !one_view) return;
    const float a_unit = 1.0F / context.text_px;
    const LabelView view{
        context.camera.eye(static_cast<float>(frame.width_px) / static_cast<float>(frame.height_px)),
        static_cast<float>(frame.width_px) * a_unit, static_cast<float>(frame.height_px) * a_unit,
        t.cut ? context.camera.distance_a() - t.cut_at * view_->radius_a() : 0.0F};
    panels_.labels = body_labels(*content_, drawn_, kind, view);
}

void DockingSystem::colour_by_fit() {
    const FitOutcome& fit = fit_controller_.outcome();
    if (fit.number == coloured_by_ || fit.residues.size() != fit.body.size()) return;
    coloured_by_ = fit.number;
    for (std::size_t i = 0; i < fit.body.size(); ++i)
        layer_->molecules().set_fit_colours(
            fit.body[i].id,
            fit_colours(docking_of(*content_).bodies[fit.body[i].structure].size(), fit.residues[i]));
}

bool DockingSystem::add_to_key(ContentKey& key) const {
    const DockingLayer::Frame& f = layer_->frame;
    for (const bool shown : {f.backbone, f.codebook, f.graph}) key.add(shown);
    if (f.codebook || f.graph) key.add(f.points_summed);
    const MoleculeLook look = layer_->molecules().look();
    key.add(look.style);
    key.add(look.colouring);
    if (look.colouring == Colouring::fit) key.add(coloured_by_);
    if (look.style == MoleculeStyle::surface) key.add(layer_->molecules().surfaces_computed());
    for (const DrawnBody& body : f.bodies) {
        key.add(body.id);
        key.add(body.structure);
        key.add(body.hidden);
        key.add(body.ghost);
        if (!body.hidden) key.add(body.T_model_body);
        for (const float a : body.amplitude_m) key.add_rounded(static_cast<double>(a), 2e-12);
    }
    return true;
}

void DockingSystem::refine() {
    Molecules& molecules = layer_->molecules();
    molecules.set_level(1.0F);
    molecules.set_shapes_max(std::max(molecules.shapes_max(), kShapesMaxAtRest));
    molecules.set_surface_vertices_max(std::max(molecules.surface_vertices_max(), kSurfaceMaxAtRest));
}

void DockingSystem::drawn(const SystemContext& context) {
    static_cast<void>(context);
    const Molecules& molecules = layer_->molecules();
    panels_.drawn_as_tubes = molecules.left_out();
    panels_.surfaces = {molecules.surfaces_awaited(), molecules.surfaces_coarse(), molecules.surface_error()};
}

void DockingSystem::add_to(LoadTopic& load) const {
    if (!layer_) return;
    load.molecule_triangles_max = layer_->molecules().triangles_max();
    load.molecule_triangles = std::min(layer_->molecules().triangles(), load.molecule_triangles_max);
}

void DockingSystem::add_to(Session& session) const {
    fit_controller_.add_to(session, list_);
    for (const Contour& contour : view_->contours().contours())
        session.contours.push_back(contour_option_text(contour));
}

void DockingSystem::restore(const Session& session) {
    fit_controller_.restore(session);
    std::vector<ContourOption> contours;
    for (const std::string& text : session.contours) contours.push_back(read_contour_option(text));
    if (contours.empty() || !options_.empty()) return;  // those of the command line go first
    view_->contours().set(contours_of(contours, content_->scale));
    begin_contours(view_->contours(), content_->scale, panels_.contours);
    count_contour();
}

void DockingSystem::finish(const SystemContext& context) {
    static_cast<void>(context);
    fit_controller_.finish_saving(std::chrono::seconds(8));  // the launcher allows ten to end
}

}  // namespace tact
