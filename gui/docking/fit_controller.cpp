#include "gui/docking/fit_controller.hpp"

#include "gui/docking/docking_content.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

// Okabe-Ito palette, safe for colour-blind users; same order as in the 3D view.
constexpr std::array<ImU32, 7> kBodyColours{IM_COL32(230, 159, 0, 255),  IM_COL32(86, 180, 233, 255),
                                            IM_COL32(0, 158, 115, 255),  IM_COL32(240, 228, 66, 255),
                                            IM_COL32(0, 114, 178, 255),  IM_COL32(213, 94, 0, 255),
                                            IM_COL32(204, 121, 167, 255)};

std::string folder_name() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::localtime_r(&now, &parts);
    char text[64];
    std::strftime(text, sizeof text, "tact-fit-%Y%m%d-%H%M%S", &parts);
    return text;
}

// Format of tact-prep export and tact-rt --poses.
nlohmann::ordered_json poses_json(const BodyList& list, const SceneContent& content) {
    nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
    for (const ShownBody& b : list.bodies()) {
        const Vec3 p = b.newest.p_m / kAngstromM;
        const Eigen::Vector4d q = b.newest.q.coeffs();
        bodies.push_back({{"id", b.id},
                          {"structure", b.structure},
                          {"name", docking_of(content).bodies[b.structure].name},
                          {"pos_model_a", {p.x(), p.y(), p.z()}},
                          {"quat_model_body_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
    }
    return {{"bodies", bodies}};
}

Command placement(std::uint32_t id, const Pose& T_model_body) {
    return {CommandKind::place_body, 0.0, {}, id, T_model_body};
}

std::string end_text(const RefineOutcome& o) {
    const RefineResult& r = o.result;
    const double shift_a = (r.T_model_body.p_m - o.start.T_model_body.p_m).norm() / kAngstromM;
    const double turn_deg = r.T_model_body.q.angularDistance(o.start.T_model_body.q) / kDegreeRad;
    char text[160];
    std::snprintf(text, sizeof text, "refined body %u: moved %.2f A, %.1f deg; density %.3f to %.3f sigma",
                  o.start.id, shift_a, turn_deg, r.score_start, r.score);
    return text;
}

}  // namespace

void FitController::use(std::shared_ptr<const SceneContent> content) {
    fit_.reset();
    refine_.reset();
    content_ = std::move(content);
    outcome_ = {};
    history_.clear();
    message_.clear();
    if (!content_ || content_->grid.values.empty() || docking_of(*content_).bodies.empty()) return;
    fit_ = std::make_unique<FitWorker>(content_);
    refine_ = std::make_unique<RefineWorker>(content_);
}

void FitController::report(Grade grade, std::string text) {
    message_ = std::move(text);
    message_grade_ = grade;
    if (grade == Grade::good)
        spdlog::info("{}", message_);
    else
        spdlog::warn("{}", message_);
}

void FitController::follow(const BodyList& list, const BodiesTopic* topic, std::vector<Command>& commands) {
    if (!content_) return;
    bodies_.clear();
    FitHistory::Places places;
    for (const ShownBody& b : list.bodies()) {
        bodies_.push_back({b.id, b.structure, b.T_model_body});
        places.push_back({b.id, b.newest});
    }
    if (topic != nullptr) history_.observe(places, {topic->grips, topic->placements, topic->active});
    if (fit_) {
        fit_->request(bodies_);
        static_cast<void>(fit_->take(outcome_));
    }
    if (refine_) {
        if (const auto done = refine_->poll()) {
            if (!done->error.empty())
                report(Grade::bad, done->error);
            else if (done->result.end == RefineEnd::no_density)
                report(Grade::watch, "refine: the map is flat here; move the body closer");
            else if (topic == nullptr)
                report(Grade::watch, "refine: no controller to move the body");
            else if (list.find(done->start.id) != nullptr) {
                commands.push_back(placement(done->start.id, done->result.T_model_body));
                report(Grade::good, end_text(*done));
            }
        }
    }
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
        case FitAction::snapshot:
            if (!history_.snapshot(request.text))
                report(Grade::watch, "snapshot not kept: too many, or name in use");
            return;
        case FitAction::restore:
            return go(history_.restore(request.text));
        case FitAction::copy:
            if (body != nullptr) copy(*body, list, commands);
            return;
        case FitAction::refine:
            if (body != nullptr && refine_ && !refine_->running())
                refine_->start({body->id, body->structure, body->newest});
            return;
        case FitAction::save:
            return save(list);
    }
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

void FitController::save(const BodyList& list) {
    if (!content_ || saving_.running()) return;
    saving_to_ = folder_name();
    try {
        if (!std::filesystem::create_directory(saving_to_))
            throw StartupError("saving in " + saving_to_, "the folder exists already",
                               "save again in a second");
        const std::string poses = saving_to_ + "/poses.json";
        std::ofstream out(poses);
        out << poses_json(list, *content_)
                   .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << '\n'
            << std::flush;
        if (!out)
            throw StartupError("writing " + poses, "the write failed", "check the free space of the disk");
        saving_.start("tact-prep", {"export", content_->path.string(), "--poses", poses, "-o", saving_to_});
    } catch (const std::exception& e) {
        report(Grade::bad, e.what());
    }
}

void FitController::describe(const BodyList& list, const BodiesTopic* topic, FittingState& state,
                             FitState& fit) const {
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
    state.options = topic != nullptr ? topic->options : 0;
    state.building = topic != nullptr && topic->building != 0;
    state.refining = refine_ && refine_->running();
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
    fit.resolution_assumed = outcome_.resolution_assumed;
    fit.bodies = outcome_.body.size();
    for (std::size_t i = 0; i < outcome_.of.size(); ++i)
        if (outcome_.body[i].id == held) fit.body = outcome_.of[i], fit.body_id = held;
}

}  // namespace tact
