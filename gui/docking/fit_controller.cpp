#include "gui/docking/fit_controller.hpp"

#include "gui/base/output_folder.hpp"
#include "gui/docking/docking_content.hpp"
#include "gui/docking/poses_json.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <thread>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/session/extend_session.hpp"

namespace tact {
namespace {

// Okabe-Ito palette, safe for colour-blind users; same order as in the 3D view.
constexpr std::array<ImU32, 7> kBodyColours{IM_COL32(230, 159, 0, 255),  IM_COL32(86, 180, 233, 255),
                                            IM_COL32(0, 158, 115, 255),  IM_COL32(240, 228, 66, 255),
                                            IM_COL32(0, 114, 178, 255),  IM_COL32(213, 94, 0, 255),
                                            IM_COL32(204, 121, 167, 255)};

Command placement(std::uint32_t id, const Pose& T_model_body) {
    return {CommandKind::place_body, 0.0, {}, id, T_model_body};
}

FitHistory::Places with(FitHistory::Places places, std::uint32_t id, const Pose& T_model_body) {
    for (FitHistory::Move& m : places)
        if (m.id == id) m.T_model_body = T_model_body;
    return places;
}

}  // namespace

void FitController::use(std::shared_ptr<const SceneContent> content) {
    fit_.reset();
    finder_.use(nullptr);
    content_ = std::move(content);
    outcome_ = {};
    history_.clear();
    message_.clear();
    if (!content_ || content_->grid.values.empty() || docking_of(*content_).bodies.empty()) return;
    fit_ = std::make_unique<FitWorker>(content_);
    finder_.use(content_);
}

void FitController::report(Grade grade, std::string text) {
    message_ = std::move(text);
    message_grade_ = grade;
    if (grade == Grade::good)
        spdlog::info("{}", message_);
    else
        spdlog::warn("{}", message_);
}

void FitController::show(const std::optional<PlaceFinder::Message>& message) {
    if (!message) return;
    if (message->text.empty())
        message_.clear();
    else
        report(message->grade, message->text);
}

void FitController::follow(const BodyList& list, const BodiesTopic* topic, double contour, bool residues,
                           std::vector<Command>& commands) {
    if (!content_) return;
    contour_ = contour;
    bodies_.clear();
    FitHistory::Places places;
    for (const ShownBody& b : list.bodies()) {
        bodies_.push_back({b.id, b.structure, b.T_model_body, b.amplitude_m});
        places.push_back({b.id, b.newest});
    }
    if (topic != nullptr) history_.observe(places, {topic->grips, topic->placements, topic->active});
    if (fit_) {
        fit_->request(bodies_, contour, residues);
        static_cast<void>(fit_->take(outcome_));
    }
    show(finder_.follow(list, topic, commands));
    if (const auto saved = saving_.poll()) {
        if (saved->good())
            report(Grade::good, "saved in " + saving_to_);
        else
            report(Grade::bad, "saving failed: " + saved->output);
    }
}

void FitController::finish_saving(Duration patience) {
    const Instant end = Monotonic::now() + patience;
    while (saving_.running() && Monotonic::now() < end) {
        if (const auto saved = saving_.poll(); saved && !saved->good())
            spdlog::error("saving failed: {}", saved->output);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

void FitController::place(std::span<const FitHistory::Move> moves, const BodyList& list,
                          std::vector<Command>& commands) {
    for (const FitHistory::Move& m : moves)
        if (list.find(m.id) != nullptr) commands.push_back(placement(m.id, m.T_model_body));
}

void FitController::perform(const FitRequest& request, const BodyList& list, std::vector<Command>& commands) {
    const ShownBody* const body = list.find(request.body);
    const auto go = [&](const FitHistory::Places& moves) { place(moves, list, commands); };
    switch (request.action) {
        case FitAction::undo:
            return go(history_.undo());
        case FitAction::redo:
            return go(history_.redo());
        case FitAction::revert:
            return go(history_.revert());
        case FitAction::accept:
            history_.accept();
            return report(Grade::good, "accepted; Revert returns to these poses");
        case FitAction::copy:
            if (body != nullptr) copy(*body, list, commands);
            return;
        case FitAction::refine:
        case FitAction::search:
            if (body != nullptr) show(finder_.look(*body, request.action == FitAction::refine, list));
            return;
        case FitAction::cancel:
            return finder_.cancel();
        case FitAction::take_place:
            if (const auto found = finder_.found(request.body, request.place); found && body != nullptr)
                commands.push_back(placement(body->id, *found));
            return;
        case FitAction::keep_place:
            if (const auto found = finder_.found(request.body, request.place); found && body != nullptr)
                keep("body " + std::to_string(body->id) + ", place " + std::to_string(request.place + 1),
                     with(history_.places(), body->id, *found));
            return;
        case FitAction::place_copies:
            if (body != nullptr) show(finder_.place_copies(*body, list, commands));
            return;
        case FitAction::snapshot:
            return keep(request.text, history_.places());
        case FitAction::restore:
            return go(history_.restore(request.text));
        case FitAction::save:
            return save(list);
    }
}

void FitController::keep(const std::string& name, const FitHistory::Places& places) {
    if (history_.snapshot(name, places))
        report(Grade::good, "kept as snapshot \"" + name + '"');
    else
        report(Grade::watch, "snapshot not kept: too many, or name in use");
}

// Places it beside the last copy, where it is visible and does not overlap.
void FitController::copy(const ShownBody& body, const BodyList& list, std::vector<Command>& commands) {
    const Structure& s = docking_of(*content_).bodies[body.structure];
    float reach_m = 0.0F;
    for (const float x : s.x_m) reach_m = std::max(reach_m, std::abs(x));
    const auto copies = std::count_if(list.bodies().begin(), list.bodies().end(),
                                      [&](const ShownBody& b) { return b.structure == body.structure; });
    Pose place = body.newest;
    place.p_m.x() += 2.2 * static_cast<double>(reach_m) * static_cast<double>(copies);
    commands.push_back({CommandKind::add_body, 0.0, {}, body.structure, place});
}

std::vector<PosedBody> FitController::posed(const BodyList& list) {
    std::vector<PosedBody> bodies;
    for (const ShownBody& b : list.bodies())
        bodies.push_back({{b.id, b.structure, b.newest, b.amplitude_m}, (b.flags & kBodyFixed) != 0});
    return bodies;
}

void FitController::add_to(Session& session, const BodyList& list) const {
    session.bodies = bodies_json(posed(list), *content_);
    for (const std::string& name : history_.snapshots()) {
        Session::Place& place = session.places.emplace_back();
        place.name = name;
        for (const FitHistory::Move& move : history_.places_of(name))
            place.bodies.push_back({move.id, move.T_model_body});
    }
    number_bodies(session);
}

void FitController::restore(const Session& session) {
    for (const Session::Place& place : session.places) {
        FitHistory::Places places;
        for (const Session::Body& body : place.bodies) places.push_back({body.id, body.T_model_body});
        if (!history_.snapshot(place.name, places))
            report(Grade::watch,
                   "snapshot \"" + place.name + "\" of the session not kept: too many, or name in use");
    }
}

void FitController::save(const BodyList& list) {
    if (!content_ || saving_.running()) return;
    try {
        saving_to_ = new_output("fit", "").string();
        if (!std::filesystem::create_directory(saving_to_))
            throw StartupError("saving in " + saving_to_, "the folder exists already",
                               "save again in a second");
        const std::string poses = saving_to_ + "/poses.json";
        std::ofstream out(poses);
        out << poses_json(posed(list), *content_) << std::flush;
        if (!out)
            throw StartupError("writing " + poses, "the write failed", "check the free space of the disk");
        char level[48];
        std::snprintf(level, sizeof level, "--contour=%.17g", contour_);
        saving_.start("tact-prep",
                      {"export", content_->path.string(), "--poses", poses, level, "-o", saving_to_});
    } catch (const std::exception& e) {
        report(Grade::bad, e.what());
    }
}

void FitController::describe(const BodyList& list, const BodiesTopic* topic, FittingState& state,
                             FitState& fit) {
    state.bodies.clear();
    const auto active = list.active();
    for (std::size_t i = 0; i < list.bodies().size() && content_; ++i) {
        const ShownBody& b = list.bodies()[i];
        const Structure& s = docking_of(*content_).bodies[b.structure];
        BodyState f;
        f.id = b.id;
        f.name = s.name;
        f.atoms = s.size();
        f.in_hand = active == i;
        f.fixed = (b.flags & kBodyFixed) != 0;
        f.hidden = b.hidden;
        f.colour = kBodyColours[b.id % kBodyColours.size()];
        state.bodies.push_back(std::move(f));
    }
    state.copies = 0;
    for (std::size_t i = 0; active && i < list.bodies().size(); ++i)
        if (i != *active && is_free_copy(list.bodies()[i], list.bodies()[*active])) ++state.copies;
    state.options = topic != nullptr ? topic->options : 0;
    state.building = topic != nullptr && topic->building != 0;
    finder_.describe(list, topic, state.search);
    state.saving = saving_.running();
    state.gestures = history_.undoable();
    state.can_undo = state.gestures > 0;
    state.can_redo = history_.redoable() > 0;
    state.snapshots = history_.snapshots();
    state.message = message_;
    state.message_grade = message_grade_;

    fit = FitState{};
    if (!fit_) {
        fit.status = content_ ? "The scene has no map or no structure to compare." : "";
        return;
    }
    const std::uint32_t held = active ? list.bodies()[*active].id : 0;
    if (active && topic != nullptr) {
        const ShownBody& b = list.bodies()[*active];
        const Pose home = docking_of(*content_).bodies[b.structure].home();
        fit.pose_known = true;
        fit.from_file_m = (b.newest.p_m - home.p_m).norm();
        fit.from_file_rad = rotation_vector_rad(b.newest.q).norm();
    }
    fit.known = outcome_.good;
    fit.status = outcome_.number == 0 ? "computing ..." : outcome_.error;
    fit.all = outcome_.all;
    fit.resolution_m = outcome_.resolution_m;
    fit.contour = outcome_.contour;
    fit.residues_current = outcome_.residues_current;
    fit.bodies = outcome_.body.size();
    for (std::size_t i = 0; i < outcome_.of.size(); ++i)
        if (outcome_.body[i].id == held) fit.body = outcome_.of[i], fit.body_id = held;
}

}  // namespace tact
