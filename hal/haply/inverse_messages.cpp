#include "hal/haply/inverse_messages.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tact::haply {

namespace {

using Json = nlohmann::json;
constexpr std::size_t kArmsMax = 16;

const Json* member(const Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto at = object.find(name);
    return at == object.end() ? nullptr : &*at;
}

std::string text_in(const Json& object, const char* name) {
    const Json* const at = member(object, name);
    if (at == nullptr || !at->is_string()) return "";
    const auto& text = at->get_ref<const std::string&>();
    return text.size() <= kIdMax ? text : "";
}

bool vector_in(const Json& object, const char* name, Vec3& out) {
    const Json* const at = member(object, name);
    if (at == nullptr) return false;
    constexpr std::array kAxes{"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        const Json* const v = member(*at, kAxes[static_cast<std::size_t>(i)]);
        if (v == nullptr || !v->is_number()) return false;
        out[i] = v->get<double>();
    }
    return out.allFinite();
}

bool says_false(const Json& object, const char* name) {
    const Json* const at = member(object, name);
    return at != nullptr && at->is_boolean() && !at->get<bool>();
}

const Json::array_t* list_in(const Json& object, const char* name) {
    const Json* const at = member(object, name);
    return at != nullptr && at->is_array() ? &at->get_ref<const Json::array_t&>() : nullptr;
}

void read_arm(const Json& arm, InverseState& s) {
    s.found = true;
    if (const Json* const config = member(arm, "config")) {
        s.configured = true;
        s.type = text_in(*config, "type");
        s.preset = text_in(*config, "preset");
        if (const Json* const basis = member(*config, "basis")) s.basis = text_in(*basis, "permutation");
    }
    if (const Json* const status = member(arm, "status"))
        s.usable = !says_false(*status, "calibrated") && !says_false(*status, "ready") &&
                   !says_false(*status, "power_supply");
    if (const Json* const state = member(arm, "state")) {
        s.posed = vector_in(*state, "cursor_position", s.at_m);
        if (!vector_in(*state, "cursor_velocity", s.speed_m_s)) s.speed_m_s.setZero();
    }
}

void read_grip(const Json& grip, InverseState& s) {
    const Json* const state = member(grip, "state");
    if (state == nullptr) return;
    if (const Json* const turn = member(*state, "orientation")) {
        Vec3 axis = Vec3::Zero();
        const Json* const w = member(*turn, "w");
        if (w != nullptr && w->is_number() && vector_in(*state, "orientation", axis)) {
            const Quat q(w->get<double>(), axis.x(), axis.y(), axis.z());
            if (std::abs(q.norm() - 1.0) < 0.01) s.turn = q.normalized();
        }
    }
    if (const Json* const buttons = member(*state, "buttons")) {
        constexpr std::array kButtons{"a", "b", "c"};
        for (std::size_t i = 0; i < kButtons.size(); ++i) {
            const Json* const b = member(*buttons, kButtons[i]);
            if (b != nullptr && b->is_boolean() && b->get<bool>()) s.buttons |= 1U << i;
        }
    }
}

std::string arm_message(std::string_view id, const char* what) {
    return "{\"inverse3\":[{\"device_id\":\"" + std::string(id) + "\"," + what + "}]}";
}

}  // namespace

std::optional<InverseState> parse(std::string_view text, std::string_view wanted_id) {
    const Json message = Json::parse(text, nullptr, false);
    if (!message.is_object()) return std::nullopt;
    InverseState s;
    const Json* mine = nullptr;
    if (const Json::array_t* const arms = list_in(message, "inverse3")) {
        for (const Json& arm : *arms) {
            const std::string id = text_in(arm, "device_id");
            if (!plain_id(id) || s.ids.size() >= kArmsMax) continue;
            s.ids.push_back(id);
            if (id == wanted_id || (wanted_id.empty() && s.ids.size() == 1)) {
                mine = &arm;
                s.id = id;
            }
        }
    }
    if (mine != nullptr && (!wanted_id.empty() || s.ids.size() == 1)) read_arm(*mine, s);
    const Json::array_t* const grips = list_in(message, "wireless_verse_grip");
    if (grips != nullptr && grips->size() == 1) read_grip(grips->front(), s);
    return s;
}

bool plain_id(std::string_view id) {
    return !id.empty() && id.size() <= kIdMax && std::all_of(id.begin(), id.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
               c == '_';
    });
}

std::string configure_message(std::string_view id) {
    std::string message =
        R"({"session":{"configure":{"profile":{"name":"tact"},"basis":{"permutation":"XYZ"}}},)";
    return message.append(
        arm_message(id, R"("configure":{"preset":"arm_front_centered"},"commands":{"probe_position":{}})")
            .substr(1));
}

std::string full_state_message(std::string_view id) {
    std::string message = R"({"session":{"force_render_full_state":{}},)";
    return message.append(arm_message(id, R"("commands":{"probe_position":{}})").substr(1));
}

std::string probe_message(std::string_view id) {
    return arm_message(id, R"("commands":{"probe_position":{}})");
}

std::string force_message(std::string_view id, const Vec3& force_n) {
    std::array<char, 160> text{};
    // As the reference of 3.5 names it; versions before 3.5, which called it "values", apply no force.
    static_cast<void>(
        std::snprintf(text.data(), text.size(),
                      R"("commands":{"set_cursor_force":{"vector":{"x":%.5f,"y":%.5f,"z":%.5f}}})",
                      force_n.x(), force_n.y(), force_n.z()));
    return arm_message(id, text.data());
}

}  // namespace tact::haply
