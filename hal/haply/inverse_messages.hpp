// The messages of Haply's Inverse Service 3.5 (JSON) that the driver reads and writes, as pure functions.
//
// Source   docs.haply.co, Inverse SDK, Service: WebSocket Protocol, Control Commands, Basis, Mount
// Frame    the service's basis XYZ: x right, y away from the user, z up; metres, newtons. Origin: the middle of
//          the workspace, by the preset arm_front_centered
// Input    not trusted: parse() accepts any bytes; numbers may be huge, never NaN
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::haply {

inline constexpr std::string_view kPreset = "arm_front_centered", kBasis = "XYZ";
inline constexpr std::size_t kIdMax = 40;

struct InverseState {
    std::vector<std::string> ids;  // of all arms that the service lists, at most 16
    // Of the arm wanted, or of the only one:
    bool found = false;
    std::string id, type;  // type: only in a full message
    bool posed = false;    // the numbers below are there
    Vec3 at_m = Vec3::Zero(), speed_m_s = Vec3::Zero();
    bool usable = true;  // false: the status says not calibrated, not ready or without power
    bool configured = false;
    std::string preset, basis;  // only in a full message (`configured`)
    // Of the only wireless grip, if any.
    std::optional<Quat> turn;
    std::uint32_t buttons = 0;  // bit 0: a, 1: b, 2: c
};

// Empty: no JSON object.
[[nodiscard]] std::optional<InverseState> parse(std::string_view text, std::string_view wanted_id);

// An identifier that the messages below may contain: letters, digits, '-', '_'; 1 to kIdMax characters.
[[nodiscard]] bool plain_id(std::string_view id);
// The first message: name of the session, origin in the middle; the answer is a full message.
[[nodiscard]] std::string configure_message(std::string_view id);
[[nodiscard]] std::string full_state_message(std::string_view id);
[[nodiscard]] std::string probe_message(std::string_view id);  // no force
[[nodiscard]] std::string force_message(std::string_view id, const Vec3& force_n);

}  // namespace tact::haply
