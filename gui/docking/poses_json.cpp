#include "gui/docking/poses_json.hpp"

#include <nlohmann/json.hpp>

#include "gui/docking/docking_content.hpp"
#include "ipc/base/units.hpp"

namespace tact {

namespace {
nlohmann::ordered_json list_of(std::span<const PosedBody> bodies, const SceneContent& content) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& [body, fixed] : bodies) {
        const Vec3 p_a = body.T_model_body.p_m / kAngstromM;
        const Eigen::Vector4d q = body.T_model_body.q.coeffs();
        list.push_back({{"id", body.id},
                        {"structure", body.structure},
                        {"name", docking_of(content).bodies.at(body.structure).name},
                        {"pos_model_a", {p_a.x(), p_a.y(), p_a.z()}},
                        {"quat_model_body_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                        {"fixed", fixed}});
        if (body.amplitude_m.empty()) continue;
        nlohmann::ordered_json& bent = list.back()["mode_amplitudes_a"] = nlohmann::ordered_json::array();
        for (const float a : body.amplitude_m) bent.push_back(static_cast<double>(a) / kAngstromM);
    }
    return list;
}
}  // namespace

std::string bodies_json(std::span<const PosedBody> bodies, const SceneContent& content) {
    return list_of(bodies, content).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string poses_json(std::span<const PosedBody> bodies, const SceneContent& content) {
    return nlohmann::ordered_json{{"bodies", list_of(bodies, content)}}.dump(
               2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
           "\n";
}

}  // namespace tact
