#include "rt/start/start_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {

using nlohmann::json;

constexpr std::uintmax_t kFileBytesMax = std::uintmax_t{16} << 20;  // more than any report of a run
constexpr double kFarthestM = 1e3;  // plausibility only; the model checks its scene's range

[[noreturn]] void fail(const std::string& where, const std::string& why) {
    throw StartupError("reading the start poses in " + where, why,
                       "give a file written by tact run --json or --out");
}

template <std::size_t N>
std::array<double, N> numbers(const json& body, const char* key, const std::string& where) {
    std::array<double, N> values{};
    const auto found = body.find(key);
    if (found == body.end() || !found->is_array() || found->size() != N)
        fail(where, std::string(key) + " is not a list of " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) {
        if (!(*found)[i].is_number()) fail(where, std::string(key) + " holds values that are not numbers");
        values[i] = (*found)[i].get<double>();
    }
    return values;
}

bool flag(const json& body, const char* key, const std::string& where) {
    const auto found = body.find(key);
    if (found == body.end()) return false;
    if (!found->is_boolean()) fail(where, std::string(key) + " is neither true nor false");
    return found->get<bool>();
}

StartBody parse_body(const json& body, const std::string& where, const std::vector<std::string>& names) {
    if (!body.is_object()) fail(where, "it is not a JSON object");
    StartBody start;
    const auto structure = body.find("structure");
    if (structure == body.end() || !structure->is_number_unsigned() ||
        structure->get<std::uint64_t>() >= names.size())
        fail(where, "structure is outside 0 to " + std::to_string(names.size() - 1) +
                        ", the structures of this scene");
    start.structure = structure->get<std::uint32_t>();
    const auto name = body.find("name");
    if (name != body.end() && (!name->is_string() || name->get<std::string>() != names[start.structure]))
        fail(where, "structure " + std::to_string(start.structure) + " of this scene is '" +
                        names[start.structure] + "', but the file has another name");
    const auto p_a = numbers<3>(body, "pos_model_a", where);
    const auto q = numbers<4>(body, "quat_model_body_xyzw", where);
    start.T_model_body = {kAngstromM * Vec3(p_a.data()), Quat(q.data())};
    const double turn = start.T_model_body.q.norm();
    if (!start.T_model_body.finite() || start.T_model_body.p_m.cwiseAbs().maxCoeff() > kFarthestM ||
        !(turn > 0.98 && turn < 1.02))
        fail(where, "its position is not finite, or its rotation is not a unit quaternion");
    start.T_model_body.q.normalize();
    start.fixed = flag(body, "fixed", where);
    start.in_hand = flag(body, "in_hand", where);
    return start;
}

}  // namespace

std::vector<StartBody> parse_start_bodies(const std::string& text, const std::string& file,
                                          const std::vector<std::string>& names) {
    const std::string where = "'" + file + "'";
    const json all = json::parse(text, nullptr, false);
    if (all.is_discarded()) fail(where, "it is not JSON");
    const auto bodies = all.is_object() ? all.find("bodies") : all.end();
    if (!all.is_object() || bodies == all.end() || !bodies->is_array())
        fail(where, "it has no list \"bodies\"");
    if (bodies->empty() || bodies->size() > ModelBodies::kMax)
        fail(where, "it lists " + std::to_string(bodies->size()) + " bodies instead of 1 to " +
                        std::to_string(ModelBodies::kMax));
    std::vector<StartBody> start;
    for (std::size_t i = 0; i < bodies->size(); ++i)
        start.push_back(parse_body((*bodies)[i], where + ", body " + std::to_string(i + 1), names));
    return start;
}

std::vector<StartBody> read_start_bodies(const std::filesystem::path& path,
                                         const std::vector<std::string>& names) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);  // fails also if the path is not a file
    std::ifstream in(path, std::ios::binary);
    if (error || !in) fail("'" + path.string() + "'", "the file cannot be opened");
    if (bytes > kFileBytesMax) fail("'" + path.string() + "'", "it is larger than any report of a run");
    std::ostringstream text;
    text << in.rdbuf();
    return parse_start_bodies(text.str(), path.string(), names);
}

std::vector<StartBody> copies_about(const DensityGrid& grid, std::uint32_t copies) {
    const Vec3 width_m(grid.spacing_m.x() * (grid.size[0] - 1.0), grid.spacing_m.y() * (grid.size[1] - 1.0),
                       grid.spacing_m.z() * (grid.size[2] - 1.0));
    const Vec3 middle_m = grid.origin_m + 0.5 * width_m;
    const double radius_m = 0.6 * std::max(width_m.x(), width_m.y());
    std::vector<StartBody> bodies;
    for (std::uint32_t i = 1; i < copies; ++i) {
        const double angle = 2.0 * M_PI * (i - 1.0) / (copies - 1.0);
        StartBody body;
        body.T_model_body.p_m = middle_m + radius_m * Vec3(std::sin(angle), std::cos(angle), 0.0);
        bodies.push_back(body);
    }
    return bodies;
}

}  // namespace tact
