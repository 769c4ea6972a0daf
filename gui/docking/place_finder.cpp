#include "gui/docking/place_finder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gui/docking/docking_content.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr std::size_t kGhosts = 3;
constexpr std::array<const char*, 3> kJudgedBy{"Laplacian", "density correlation", "mean density"};
constexpr std::array<const char*, 3> kUnit{"", "", " σ"};

std::string refined_text(const PlacementOutcome& o) {
    const FoundPlace& place = o.found.front();
    const double shift_a = (place.T_model_body.p_m - o.start.T_model_body.p_m).norm() / kAngstromM;
    const double turn_deg = place.T_model_body.q.angularDistance(o.start.T_model_body.q) / kDegreeRad;
    const std::string text =
        printed("refined body %u: %.2f Å, %.1f°; %.3f to %.3f%s", o.start.id, shift_a, turn_deg,
                place.score_start, place.score, kUnit[static_cast<std::size_t>(o.objective)]);
    return place.z > 0.0 ? text + printed(", z %.1f", place.z) : text;
}

bool moves_along(const ShownBody& other, const ShownBody& body, std::uint32_t options) {
    return (options & kDockingTogether) != 0 && is_free_copy(other, body);
}

}  // namespace

bool is_free_copy(const ShownBody& other, const ShownBody& body) {
    return other.id != body.id && other.structure == body.structure && (other.flags & kBodyFixed) == 0;
}

void PlaceFinder::use(std::shared_ptr<const SceneContent> content) {
    content_ = std::move(content);
    job_ = content_ ? std::make_unique<PlacementJob>(content_, programs_) : nullptr;
    found_ = {};
    pull_ = pull_asked_ = places_sent_ = false;
}

std::optional<PlaceFinder::Message> PlaceFinder::follow(const BodyList& list, const BodiesTopic* topic,
                                                        std::vector<Command>& commands) {
    if (!job_) return std::nullopt;
    options_ = topic != nullptr ? topic->options : 0;
    std::optional<Message> message;
    if (std::optional<PlacementOutcome> done = job_->poll())
        message = take(std::move(*done), list, topic, commands);
    send_pull(topic, commands);
    return message;
}

PlaceFinder::Message PlaceFinder::take(PlacementOutcome done, const BodyList& list, const BodiesTopic* topic,
                                       std::vector<Command>& commands) {
    const std::uint32_t id = done.start.id;
    if (done.cancelled) return {Grade::watch, done.nearby ? "refining cancelled" : "search cancelled"};
    if (!done.error.empty()) return {Grade::bad, done.error};
    if (!done.nearby) {
        if (done.found.empty()) return {Grade::watch, "no place found"};
        spdlog::info("{} places of body {} found; {} of the first {:.3f}", done.found.size(), id,
                     kJudgedBy[static_cast<std::size_t>(done.objective)], done.found.front().score);
        found_ = std::move(done);
        found_radius_m_ = radius_of_gyration_m(docking_of(*content_).bodies[found_.start.structure]);
        places_sent_ = false;
        return {Grade::good, {}};  // the list tells it
    }
    if (topic == nullptr) return {Grade::watch, "refined, but there is no controller to move the body"};
    const ShownBody* const body = list.find(id);
    if (body == nullptr) return {Grade::watch, "refined, but the body was removed"};
    const Pose& place = done.found.front().T_model_body;
    commands.push_back({CommandKind::place_body, 0.0, {}, id, place});
    if ((options_ & kDockingTogether) != 0) {
        const Pose step = body->newest.inverse() * place;
        for (const ShownBody& other : list.bodies())
            if (is_free_copy(other, *body))
                commands.push_back({CommandKind::place_body, 0.0, {}, other.id, other.newest * step});
    }
    return {Grade::good, refined_text(done)};
}

// With Subtract on, the hand feels the map without all other bodies; otherwise those that are fixed are known.
std::vector<FitBody> PlaceFinder::subtracted(std::uint32_t body, const BodyList& list) const {
    std::vector<FitBody> others;
    const ShownBody* const looked_for = list.find(body);
    if (looked_for == nullptr) return others;
    for (const ShownBody& b : list.bodies())
        if (b.id != body && ((b.flags & kBodyFixed) != 0 || ((options_ & kDockingSubtraction) != 0 &&
                                                             !moves_along(b, *looked_for, options_))))
            others.push_back({b.id, b.structure, b.newest});
    return others;
}

std::optional<PlaceFinder::Message> PlaceFinder::look(const ShownBody& body, bool nearby,
                                                      const BodyList& list) {
    if (!job_ || job_->running()) return std::nullopt;
    try {
        job_->start({{body.id, body.structure, body.newest},
                     subtracted(body.id, list),
                     objective_,
                     nearby,
                     nearby ? std::string{} : symmetry_});
    } catch (const std::exception& e) {
        return Message{Grade::bad, e.what()};
    }
    return Message{};
}

void PlaceFinder::cancel() {
    if (job_) job_->cancel();
}

std::optional<Pose> PlaceFinder::found(std::uint32_t body, std::size_t place) const {
    if (body != found_.start.id || place >= found_.found.size()) return std::nullopt;
    return found_.found[place].T_model_body;
}

double PlaceFinder::away_m(const Pose& place, const Pose& here) const {
    return std::hypot((place.p_m - here.p_m).norm(), found_radius_m_ * place.q.angularDistance(here.q));
}

std::optional<PlaceFinder::Message> PlaceFinder::place_copies(const ShownBody& body, const BodyList& list,
                                                              std::vector<Command>& commands) const {
    if (found_.symmetry.empty() || body.id != found_.start.id) return std::nullopt;
    std::vector<std::uint32_t> ids{body.id};
    for (const ShownBody& other : list.bodies())
        if (is_free_copy(other, body)) ids.push_back(other.id);
    const std::size_t wanted = found_.found.size(), others = list.bodies().size() - ids.size();
    if (wanted + others > kBodiesMax)
        return Message{Grade::watch, std::to_string(wanted) + " copies and " + std::to_string(others) +
                                         " other bodies are more than " + std::to_string(kBodiesMax)};
    std::vector<Pose> free;
    for (const FoundPlace& f : found_.found) free.push_back(f.T_model_body);
    for (const std::uint32_t id : ids) {  // each to the nearest place, so that no more moves than must
        if (free.empty()) break;
        const Pose& here = list.find(id)->newest;
        const auto nearest = std::min_element(free.begin(), free.end(), [&](const Pose& a, const Pose& b) {
            return away_m(a, here) < away_m(b, here);
        });
        commands.push_back({CommandKind::place_body, 0.0, {}, id, *nearest});
        free.erase(nearest);
    }
    for (const Pose& place : free)
        commands.push_back({CommandKind::add_body, 0.0, {}, body.structure, place});
    commands.push_back({CommandKind::set_together, 1.0, {}});
    return Message{Grade::good,
                   std::to_string(wanted) + " copies by " + found_.symmetry + " placed; they move together"};
}

std::vector<DrawnBody> PlaceFinder::ghosts(const BodyList& list) const {
    const ShownBody* const body = list.find(found_.start.id);
    if (body == nullptr || body->structure != found_.start.structure) return {};
    std::vector<const FoundPlace*> nearest;
    for (const FoundPlace& f : found_.found) nearest.push_back(&f);
    const Pose& here = body->T_model_body;
    std::sort(nearest.begin(), nearest.end(), [&](const FoundPlace* a, const FoundPlace* b) {
        return away_m(a->T_model_body, here) < away_m(b->T_model_body, here);
    });
    nearest.resize(std::min(kGhosts, nearest.size()));
    std::vector<DrawnBody> drawn;
    for (const FoundPlace* f : nearest)
        drawn.push_back({f->T_model_body, body->structure, body->id, false, true});
    return drawn;
}

void PlaceFinder::send_pull(const BodiesTopic* topic, std::vector<Command>& commands) {
    if (topic == nullptr) {  // the next controller knows nothing of it
        pull_asked_ = places_sent_ = false;
        return;
    }
    if (pull_ && !places_sent_ && !found_.found.empty()) {
        commands.push_back({CommandKind::clear_found_places, 0.0, {}});
        const double best = found_.found.front().score;
        const auto worth = [best](double score) {
            return best > 0.0 ? std::clamp(score / best, 0.0, 1.0) : 1.0;
        };
        for (const FoundPlace& f : found_.found)
            commands.push_back(
                {CommandKind::add_found_place, worth(f.score), {}, found_.start.id, f.T_model_body});
        places_sent_ = true;
    }
    if (pull_ != pull_asked_) commands.push_back({CommandKind::set_pull, pull_ ? 1.0 : 0.0, {}});
    pull_asked_ = pull_;
}

void PlaceFinder::describe(const BodyList& list, const BodiesTopic* topic, SearchState& s) {
    objective_ = static_cast<PlaceObjective>(std::clamp(s.objective, 0, 2));
    symmetry_ = s.symmetry.data();
    s.running = job_ && job_->running();
    if (s.running) {
        s.nearby = job_->pending().nearby;
        s.running_body = job_->pending().start.id;
        s.progress = job_->progress();
    }
    const auto active = list.active();
    const std::uint32_t held = active ? list.bodies()[*active].id : 0;
    s.subtracted = active ? subtracted(held, list).size() : 0;
    s.found.clear();
    s.found_body = found_.start.id;
    s.found_symmetry = found_.symmetry;
    if (!found_.found.empty()) s.found_name = docking_of(*content_).bodies[found_.start.structure].name;
    const ShownBody* const body = list.find(found_.start.id);
    const Vec3 here_m = (body != nullptr ? body->T_model_body : found_.start.T_model_body).p_m;
    for (const FoundPlace& f : found_.found)
        s.found.push_back({f.score, f.z, (f.T_model_body.p_m - here_m).norm(), f.clashes});

    s.can_pull = active && topic != nullptr && !found_.found.empty() && held == found_.start.id;
    s.pull = s.pull && !found_.found.empty();
    pull_ = s.pull;
    // What the controller does now, not what was asked of it.
    const bool pulls = s.can_pull && (topic->options & kDockingPull) != 0 && topic->place < s.found.size() &&
                       topic->pull_n > 0.0F;
    s.pull_n = pulls ? static_cast<double>(topic->pull_n) : 0.0;
    s.place = pulls ? topic->place + 1 : 0;
}

}  // namespace tact
