// Messages of OpenIGTLink, decoded: the header of any message, and the poses of TRANSFORM and TDATA.
//
// Frame    the sender's, right-handed. Millimetres in the message, metres here
// Version  headers of version 1 (protocol 1 and 2) to 3. From version 2 on (protocol 3) an extended header precedes the
//          content, and metadata follow it; of these, TransformStatus of PLUS and 3D Slicer is read
// Hostile  any bytes: every size is checked against the bytes at hand before it is used; decoded names are printable,
//          decoded poses finite with a unit quaternion
// Source   openigtlink.org, protocol version 3; checksum and byte order by libopenigtlink
// Thread   any; no allocation
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr int kIgtlPort = 18944;  // registered for OpenIGTLink
inline constexpr std::size_t kIgtlHeaderBytes = 58;
inline constexpr std::size_t kIgtlTypeMax = 12, kIgtlNameMax = 20;
inline constexpr std::uint64_t kIgtlBodyMost = std::uint64_t{1}
                                               << 30;  // an image of 1 GiB; more is no message
inline constexpr std::size_t kIgtlPosesMax = 64;       // of one TDATA

// A field of a message; '?' replaces each byte that is not printable.
template <std::size_t size>
struct IgtlText {
    std::array<char, size> chars{};  // padded with 0
    [[nodiscard]] constexpr std::string_view view() const noexcept {
        const std::string_view all(chars.data(), size);
        return all.substr(0, all.find('\0'));
    }
};

struct IgtlHeader {
    std::uint16_t version = 0;
    IgtlText<kIgtlTypeMax> type;    // "TRANSFORM"
    IgtlText<kIgtlNameMax> device;  // name of the device, by which receivers tell messages apart
    std::int64_t time_ns = 0;       // since 1970, by the sender's clock; 0: not stated
    std::uint64_t body_bytes = 0;
    std::uint64_t crc = 0;
};

enum class IgtlHeaderFault : std::uint8_t {
    none,
    version,  // not 1 to 3
    type,     // empty or not printable
    size,     // more than kIgtlBodyMost
};

// A faulty header means that the stream is no OpenIGTLink or lost its place: nothing after it can be read.
[[nodiscard]] IgtlHeaderFault decode_header(std::span<const std::byte, kIgtlHeaderBytes> bytes,
                                            IgtlHeader& out) noexcept;

enum class IgtlFault : std::uint8_t {
    none,
    other_type,  // neither TRANSFORM nor TDATA
    length,      // of the body: not that of the header, of the type, or more than kIgtlPosesMax
    crc,
};

enum class IgtlPoseFault : std::uint8_t {
    none,
    not_finite,
    rotation,   // the matrix is no rotation: off by more than kIgtlRotationError
    not_valid,  // by its TransformStatus, which is not "OK"
    identity,   // exactly the identity, which servers send in place of a pose that they do not have
};
inline constexpr double kIgtlRotationError = 0.01;  // of a product of two columns

struct IgtlPose {
    IgtlText<kIgtlNameMax> name;  // device of a TRANSFORM; element of a TDATA
    IgtlPoseFault fault = IgtlPoseFault::none;
    Pose T;  // identity if faulty
};

struct IgtlPoses {
    std::size_t count = 0;
    std::array<IgtlPose, kIgtlPosesMax> pose;
};

// On a result other than `none`, `out` is empty.
[[nodiscard]] IgtlFault decode_poses(const IgtlHeader& header, std::span<const std::byte> body,
                                     IgtlPoses& out) noexcept;

}  // namespace tact
