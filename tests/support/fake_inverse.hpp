// A substitute for Haply's Inverse Service: one state for each message, an arm of 0.25 kg in oil, errors on demand.
//
// Frame    the service's: x right, y away from the user, z up
// Strict   a force applies for one message; after 5 ms without one the arm returns to idle. Presets and basis are
//          those that the client asked for, where the service is of version 3.5
// Thread   one
#pragma once

#include <array>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "hal/haply/inverse_link.hpp"

namespace tact {

// A frame as a server sends it.
inline std::string server_frame(haply::Opcode opcode, std::string_view payload, bool final = true) {
    std::string out;
    out.push_back(static_cast<char>((final ? 0x80U : 0U) | static_cast<unsigned>(opcode)));
    const std::size_t n = payload.size();
    if (n < 126) {
        out.push_back(static_cast<char>(n));
    } else {
        out.push_back(n <= 0xFFFF ? 126 : 127);
        for (int i = n <= 0xFFFF ? 1 : 7; i >= 0; --i) out.push_back(static_cast<char>(n >> (8 * i) & 0xFF));
    }
    return out.append(payload);
}

struct FakeInverse {
    using Json = nlohmann::json;

    bool running = true, plugged = true, silent = false, breaks = false, garbage = false;
    bool old_version = false;  // ignores the configuration
    bool calibrated = true, second = false, grip = false;
    std::string type = "inverse3", raw;  // raw: the next answer
    std::array<double, 3> at_m{}, speed_m_s{}, force_n{};
    std::array<double, 4> turn_wxyz{1, 0, 0, 0};
    unsigned buttons = 0;
    std::string preset = "defaults", basis = "XYZ";
    int idle_ms = 0, opens = 0, forces = 0, messages = 0;

    [[nodiscard]] static Json vector(const std::array<double, 3>& v) {
        return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
    }
    [[nodiscard]] std::string state(bool full) const {
        Json arm = {{"device_id", "049D"},
                    {"state", {{"cursor_position", vector(at_m)}, {"cursor_velocity", vector(speed_m_s)}}},
                    {"status", {{"calibrated", calibrated}, {"ready", true}, {"power_supply", true}}}};
        if (full) {
            arm["config"] = {{"type", type}};
            if (!old_version) {
                arm["config"]["preset"] = preset;
                arm["config"]["basis"] = {{"permutation", basis}};
            }
        }
        Json all = {{"session_id", 7}, {"inverse3", Json::array()}, {"wireless_verse_grip", Json::array()}};
        if (second) all["inverse3"].push_back({{"device_id", "0007"}, {"state", Json::object()}});
        if (plugged) all["inverse3"].push_back(arm);
        if (grip)
            all["wireless_verse_grip"].push_back(
                {{"device_id", "61576"},
                 {"state",
                  {{"orientation",
                    {{"w", turn_wxyz[0]}, {"x", turn_wxyz[1]}, {"y", turn_wxyz[2]}, {"z", turn_wxyz[3]}}},
                   {"buttons",
                    {{"a", (buttons & 1U) != 0}, {"b", (buttons & 2U) != 0}, {"c", (buttons & 4U) != 0}}}}}});
        return all.dump();
    }
    [[nodiscard]] std::string answer(const std::string& text) {
        ++messages;
        idle_ms = 0;
        force_n = {};
        const Json message = Json::parse(text, nullptr, false);
        bool full = false;
        if (message.is_object()) {
            full = message.contains("/session/force_render_full_state"_json_pointer);
            if (!old_version && message.contains("/session/configure/basis"_json_pointer))
                basis = message["session"]["configure"]["basis"]["permutation"];
            for (const Json& arm : message.value("inverse3", Json::array())) {
                if (arm.value("device_id", "") != "049D") continue;
                if (!old_version && arm.contains("/configure/preset"_json_pointer))
                    preset = arm["configure"]["preset"];
                if (const auto at = "/commands/set_cursor_force/vector"_json_pointer; arm.contains(at)) {
                    ++forces;
                    force_n = {arm[at]["x"], arm[at]["y"], arm[at]["z"]};
                }
            }
        }
        return raw.empty() ? state(full) : raw;
    }
    void tick() {  // a millisecond
        if (++idle_ms > 5 || !plugged) force_n = {};
        for (std::size_t i = 0; i < 3; ++i) {
            speed_m_s[i] += 1e-3 * (force_n[i] - 5.0 * speed_m_s[i]) / 0.25;
            at_m[i] += 1e-3 * speed_m_s[i];
        }
    }
};

class FakeInverseChannel final : public haply::Channel {
public:
    explicit FakeInverseChannel(FakeInverse& service) : service_(service) {}
    std::string open() override {
        close();
        if (!service_.running) return "no connection: Connection refused";
        ++service_.opens;
        open_ = true;
        answers_.push_back(service_.state(true));
        return "";
    }
    void close() noexcept override {
        open_ = false;
        answers_.clear();
    }
    bool send(std::string_view text) override {
        if (!open_ || !service_.running || service_.breaks) return false;
        const std::string answer = service_.answer(std::string(text));
        if (!service_.silent) answers_.push_back(service_.garbage ? "{\"inverse3\":[" : answer);
        return true;
    }
    haply::ReadResult receive(std::string& text, Duration /*patience*/) override {
        if (!open_ || !service_.running || service_.breaks) return haply::ReadResult::broken;
        if (answers_.empty()) return haply::ReadResult::need_more;
        text = answers_.front();
        answers_.pop_front();
        return haply::ReadResult::message;
    }

private:
    FakeInverse& service_;
    std::deque<std::string> answers_;
    bool open_ = false;
};

}  // namespace tact
