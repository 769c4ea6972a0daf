#include "prep/export/poses_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/normal_modes.hpp"

namespace tact {
namespace {

constexpr std::size_t kBodiesInFileMax = 1024;
constexpr double kFarthestA = 1e5, kAmplitudeMostA = 1e3;

using nlohmann::json;

template <std::size_t N>
std::array<double, N> numbers(const json& body, const char* key, const auto& fail) {
    std::array<double, N> out{};
    const auto at = body.find(key);
    if (at == body.end() || !at->is_array() || at->size() != N)
        fail(std::string(key) + " is not a list of " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) {
        if (!(*at)[i].is_number()) fail(std::string(key) + " holds an element that is not a number");
        out[i] = (*at)[i].template get<double>();
        if (!std::isfinite(out[i])) fail(std::string(key) + " holds a number that is not finite");
    }
    return out;
}

std::uint32_t whole(const json& body, const char* key, std::uint32_t most, const auto& fail) {
    const auto at = body.find(key);
    if (at == body.end() || !at->is_number_integer() || at->template get<double>() < 0.0 ||
        at->template get<double>() > static_cast<double>(most))
        fail(std::string(key) + " is not a whole number from 0 to " + std::to_string(most));
    return at->template get<std::uint32_t>();
}

}  // namespace

std::vector<PlacedBody> read_poses(std::string_view text, const std::string& name, std::uint32_t structures) {
    const std::string attempt = "read body poses from " + name;
    const char* const fix = "use the bodies of a run.json, or save the poses again";
    const json all = json::parse(text.begin(), text.end(), nullptr, false);
    const auto refuse = [&](const std::string& why) { throw StartupError(attempt, why, fix); };
    if (all.is_discarded()) refuse("the file is not JSON");
    const auto list = all.is_object() ? all.find("bodies") : all.end();
    if (!all.is_object() || list == all.end() || !list->is_array()) refuse("the file has no list \"bodies\"");
    if (list->empty() || list->size() > kBodiesInFileMax)
        refuse("the list has " + std::to_string(list->size()) + " bodies, outside 1 to " +
               std::to_string(kBodiesInFileMax));
    std::vector<PlacedBody> bodies;
    for (const json& b : *list) {
        const auto fail = [&](const std::string& why) {
            refuse("body " + std::to_string(bodies.size() + 1) + ": " + why);
        };
        if (!b.is_object()) fail("the entry is not an object");
        PlacedBody body;
        body.id = whole(b, "id", 0xFFFFFFFEU, fail);
        body.structure = whole(b, "structure", structures - 1, fail);
        const auto p = numbers<3>(b, "pos_model_a", fail);
        const auto q = numbers<4>(b, "quat_model_body_xyzw", fail);
        for (const double x : p)
            if (std::abs(x) > kFarthestA) fail("the position is more than 100000 ångström from the origin");
        body.T_model_body = {kAngstromM * Vec3(p[0], p[1], p[2]), Quat(q[3], q[0], q[1], q[2])};
        if (const auto fixed = b.find("fixed"); fixed != b.end()) {
            if (!fixed->is_boolean()) fail("fixed is neither true nor false");
            body.fixed = fixed->get<bool>();
        }
        if (const auto bent = b.find("mode_amplitudes_a"); bent != b.end()) {
            if (!bent->is_array() || bent->size() > kModesMax)
                fail("mode_amplitudes_a is not a list of at most " + std::to_string(kModesMax) + " numbers");
            for (const json& a : *bent) {
                if (!a.is_number() || !(std::abs(a.get<double>()) <= kAmplitudeMostA))
                    fail("mode_amplitudes_a holds something else than a number from -1000 to 1000");
                body.amplitude_m.push_back(static_cast<float>(kAngstromM * a.get<double>()));
            }
        }
        if (!(std::abs(body.T_model_body.q.norm() - 1.0) < 1e-3))
            fail("quat_model_body_xyzw does not have length 1");
        body.T_model_body.q.normalize();
        if (std::any_of(bodies.begin(), bodies.end(), [&](const PlacedBody& o) { return o.id == body.id; }))
            fail("the id " + std::to_string(body.id) + " is used twice");
        bodies.push_back(body);
    }
    return bodies;
}

}  // namespace tact
