// Listens to an OpenIGTLink server for a moment: which poses it sends, for `tact probe`.
//
// Input    the server is not trusted: bytes, names and their number are bounded; names are printable
// Thread   any; takes about `patience`, up to 2 s more for the connection
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact::probe {

inline constexpr std::size_t kIgtlNamesMax = 64;
inline constexpr std::size_t kIgtlBytesMax = std::size_t{64} << 20U;  // read at most

struct IgtlSent {
    std::string type;  // of the message: "TRANSFORM"; "TDATA" for each of its elements
    std::string name;
    std::uint64_t count = 0;
    std::uint64_t valid = 0;  // with a pose that the tracker's driver accepts, wherever it is
};

struct IgtlAnswer {
    std::string problem;  // why there is no connection, or why it ended; "": none
    double listened_s = 0.0;
    std::vector<IgtlSent> sent;
    bool more = false;  // more names than kIgtlNamesMax: the rest is ignored
    std::uint64_t checksum_errors = 0;
};

// period: least time between two TDATA, as the server is asked.
[[nodiscard]] IgtlAnswer listen_to_igtl(const std::string& host, int port, Duration period,
                                        Duration patience);

}  // namespace tact::probe
