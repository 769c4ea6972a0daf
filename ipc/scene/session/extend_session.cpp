#include "ipc/scene/session/extend_session.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/start_place.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {
namespace {

using nlohmann::ordered_json;

ordered_json body_list(const Session& session) {
    if (session.bodies.empty()) return ordered_json::array();
    ordered_json list = ordered_json::parse(session.bodies, nullptr, false);
    const bool sound = list.is_array() && std::all_of(list.begin(), list.end(), [](const ordered_json& body) {
                           return body.is_object();
                       });
    if (!sound)
        throw StartupError("continuing the session of " + session.scene.string(), "its bodies are not a list",
                           "save the session again");
    return list;
}

ordered_json body_of(std::uint32_t structure, const std::string& name, const Pose& pose) {
    const Vec3 p_a = pose.p_m / kAngstromM;
    const Eigen::Vector4d q = pose.q.coeffs();
    return {{"id", 0},
            {"structure", structure},
            {"name", name},
            {"pos_model_a", {p_a.x(), p_a.y(), p_a.z()}},
            {"quat_model_body_xyzw", {q.x(), q.y(), q.z(), q.w()}},
            {"fixed", false}};
}

// Where a body of the list is; one without a place cannot be in the way, and the controller refuses it.
std::optional<BodyBall> ball_in_list(const ordered_json& body, const std::vector<Structure>& structures) {
    const auto structure = body.find("structure"), at = body.find("pos_model_a");
    if (structure == body.end() || !structure->is_number_unsigned() ||
        structure->get<std::uint64_t>() >= structures.size() || at == body.end() || !at->is_array() ||
        at->size() != 3 || !std::all_of(at->begin(), at->end(), [](const auto& n) { return n.is_number(); }))
        return std::nullopt;
    Pose pose;
    for (int a = 0; a < 3; ++a) pose.p_m[a] = kAngstromM * (*at)[static_cast<std::size_t>(a)].get<double>();
    return ball_of(structures[structure->get<std::size_t>()], pose);
}

std::string hex_text(std::uint64_t checksum) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum));
    return text;
}

}  // namespace

void number_bodies(Session& session) {
    ordered_json list = body_list(session);
    std::map<std::uint64_t, std::uint32_t> number;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto now = static_cast<std::uint32_t>(i + 1);
        if (const auto id = list[i].find("id"); id != list[i].end() && id->is_number_unsigned())
            number.emplace(id->get<std::uint64_t>(), now);
        list[i]["id"] = now;
    }
    if (!list.empty()) session.bodies = list.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    for (Session::Place& place : session.places) {
        std::vector<Session::Body> kept;
        for (const Session::Body& body : place.bodies)
            if (const auto at = number.find(body.id); at != number.end())
                kept.push_back({at->second, body.T_model_body});
        place.bodies = std::move(kept);
    }
    std::erase_if(session.places, [](const Session::Place& place) { return place.bodies.empty(); });
}

Session extended_session(const Session& before, const SceneFile& shown, const SceneFile& extended) {
    Session session = before;
    session.scene = std::filesystem::absolute(extended.name());
    session.scene_checksum = extended.checksum();
    // The view is kept for the scene with this checksum.
    const std::string was = hex_text(before.scene_checksum);
    if (const auto at = session.window.find(was); at != std::string::npos)
        session.window.replace(at, was.size(), hex_text(session.scene_checksum));

    const std::uint32_t known = read_meta(shown).body_count, count = read_meta(extended).body_count;
    if (known >= count)
        throw StartupError("adding a structure to " + shown.name(),
                           extended.name() + " has no more structures", "add it to the scene that is shown");
    std::vector<Structure> structures;
    for (std::uint32_t i = 0; i < count; ++i) structures.push_back(read_structure(extended, i));
    const DensityGrid grid = read_grid(extended);
    ordered_json list = body_list(session);
    if (list.empty())
        for (std::uint32_t i = 0; i < known; ++i)
            list.push_back(body_of(i, structures[i].name, structures[i].home()));
    std::vector<BodyBall> placed;
    for (ordered_json& body : list) {
        body["in_hand"] = false;
        if (const auto ball = ball_in_list(body, structures)) placed.push_back(*ball);
    }
    for (std::uint32_t i = known; i < count; ++i) {
        const Pose home = structures[i].home();
        const Pose pose =
            overlaps(grid, structures[i], home) ? home : place_beside(grid, structures[i], placed);
        placed.push_back(ball_of(structures[i], pose));
        list.push_back(body_of(i, structures[i].name, pose));
        list.back()["id"] = 1'000'000 + i;  // free until they are numbered
        list.back()["in_hand"] = i == known;
    }
    session.bodies = list.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    number_bodies(session);
    return session;
}

}  // namespace tact
