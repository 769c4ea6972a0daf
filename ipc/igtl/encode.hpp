// Messages of OpenIGTLink, encoded by libopenigtlink (version 2 of the protocol, which later versions read).
//
// Units    metres and radians here; poses in millimetres in the message. time_ns: since 1970 (UTC); 0: not stated
// Names    cut to kIgtlNameMax bytes
// Errors   std::bad_alloc
// Thread   any, allocates
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/igtl/decode.hpp"

namespace tact {

using IgtlBytes = std::vector<std::byte>;

enum class IgtlUnit : std::uint8_t { newton, newton_metre, millimetre, none };

// The codes of the protocol that Tact uses.
enum class IgtlStatus : std::uint8_t {
    ok = 1,
    unknown_error = 2,
    emergency = 3,
    not_ready = 13,
    disabled = 15,
    not_present = 16,
    shut_down = 19,
};

struct IgtlNamedPose {
    std::string_view name;
    Pose T;
};

void append_transform(IgtlBytes& out, std::string_view device, const Pose& T, std::int64_t time_ns);
void append_tdata(IgtlBytes& out, std::string_view device, std::span<const IgtlNamedPose> poses,
                  std::int64_t time_ns);
void append_sensor(IgtlBytes& out, std::string_view device, std::span<const double> values, IgtlUnit unit,
                   std::int64_t time_ns);
void append_status(IgtlBytes& out, std::string_view device, IgtlStatus code, std::int64_t subcode,
                   std::string_view name, std::string_view text, std::int64_t time_ns);
void append_string(IgtlBytes& out, std::string_view device, std::string_view text, std::int64_t time_ns);
// Asks a server for TDATA, at most once per period.
void append_start_tdata(IgtlBytes& out, int period_ms);

}  // namespace tact
