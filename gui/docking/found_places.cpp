#include "gui/docking/found_places.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr double kFarthestA = 1e5;

[[noreturn]] void refuse(const std::string& why) {
    throw StartupError("reading the places found", why,
                       "the bodies stay where they are; report this message");
}

double number(const nlohmann::json& in, const char* key) {
    const auto at = in.find(key);
    if (at == in.end() || !at->is_number() || !std::isfinite(at->get<double>()))
        refuse(std::string(key) + " is missing or not a finite number");
    return at->get<double>();
}

Pose pose_of(const nlohmann::json& place, const Vec3& home_com_model_m) {
    const auto at = place.find("matrix");
    if (at == place.end() || !at->is_array() || at->size() != 12)
        refuse("a matrix does not have twelve numbers");
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m;
    for (std::size_t i = 0; i < 12; ++i) {
        if (!(*at)[i].is_number()) refuse("a matrix holds an element that is not a number");
        m.data()[i] = (*at)[i].get<double>();
    }
    const Eigen::Matrix3d turn = m.leftCols<3>();
    if (!m.allFinite() || !(turn * turn.transpose()).isIdentity(1e-4) || turn.determinant() < 0.0 ||
        !(m.col(3).norm() < kFarthestA))
        refuse("a matrix is not a motion");
    Pose pose;
    pose.q = Quat(turn).normalized();
    pose.p_m = kAngstromM * m.col(3) + turn * home_com_model_m;
    return pose;
}

}  // namespace

std::vector<FoundPlace> read_found(std::string_view text, const Vec3& home_com_model_m, bool nearby) {
    const nlohmann::json all = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
    const char* const key = nearby ? "bodies" : "hits";
    const auto list = all.is_object() ? all.find(key) : all.end();
    if (!all.is_object() || list == all.end() || !list->is_array())
        refuse(std::string("the file has no list \"") + key + '"');
    std::vector<FoundPlace> found;
    for (const nlohmann::json& place : *list) {
        if (found.size() == (nearby ? 1 : kFoundMax)) break;
        if (!place.is_object()) refuse("a place is not an object");
        FoundPlace f;
        f.T_model_body = pose_of(place, home_com_model_m);
        f.score = number(place, nearby ? "score_after" : "score");
        if (nearby) {
            f.score_start = number(place, "score_before");
            if (place.contains("z")) f.z = number(place, "z");
        } else {
            f.z = number(place, "z");
            f.clashes = static_cast<std::uint64_t>(std::clamp(number(place, "clashes"), 0.0, 1e15));
        }
        found.push_back(f);
    }
    if (nearby && found.empty()) refuse("the list is empty");
    return found;
}

std::string found_symmetry(std::string_view text) {
    const nlohmann::json all = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
    const nlohmann::json::json_pointer at("/searches/0/symmetry/name");
    if (!all.is_object() || !all.contains(at) || !all[at].is_string()) return {};
    constexpr std::size_t kLongest = 64;
    return printable(all[at].get<std::string>().substr(0, kLongest));
}

}  // namespace tact
