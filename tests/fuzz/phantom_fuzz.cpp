// Packets from an arm's board, or any device with its identifiers, and packets to a board. The first byte selects: 0 uses
// the bytes unchanged; otherwise the rest gets a header and a valid checksum, so that the later code is reached.
#include <algorithm>

#include "hal/phantom/amplifier.hpp"
#include "hal/phantom/packets.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

using namespace tact::phantom;

std::uint32_t crc_of(std::span<const std::byte> bytes) {
    std::uint32_t c = 0xFFFFFFFFU;
    for (const std::byte b : bytes) {
        for (unsigned k = 0; k < 8; ++k) {
            c = (c >> 1U) ^ (((c ^ (static_cast<unsigned>(b) >> k)) & 1U) != 0 ? 0xEDB88320U : 0U);
        }
    }
    return ~c;
}

// An accepted packet encodes to the same bytes again.
template <class Packet>
bool faithful(std::span<const std::byte> bytes) {
    Packet packet{};
    if (decode(bytes, packet) != PacketFault::none) {
        require(packet == Packet{});
        return false;
    }
    const auto again = encode(packet);
    require(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
    return true;
}

bool use(std::span<const std::byte> bytes) {
    Amplifier board(7, {1000, 1000, 1000, 1000, 1000, 1000});
    Command first;
    first.boot = 7;
    first.sequence = 1;
    board.receive(encode(first), 1000);
    board.receive(bytes, 2000);
    require(board.current_ma() == decltype(first.current_ma){} || board.state() == AmplifierState::on);
    for (const std::int16_t ma : board.current_ma()) require(ma >= -1000 && ma <= 1000);
    const bool state = faithful<State>(bytes), command = faithful<Command>(bytes);
    const bool query = faithful<Query>(bytes), info = faithful<Info>(bytes);
    return state || command || query || info;
}

Input seed(std::byte kind, std::span<const std::byte> rest) {
    Input out(rest.size() + 1);
    out[0] = kind;
    std::copy(rest.begin(), rest.end(), out.begin() + 1);
    return out;
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const auto rest = input.subspan(1);
    if (input[0] == std::byte{0} || rest.size() < 8) return use(rest);
    Input made(rest.begin(), rest.end());
    const std::uint32_t crc = crc_of(std::span(made).first(made.size() - 4));
    for (std::size_t i = 0; i < 4; ++i) {
        made[made.size() - 4 + i] = static_cast<std::byte>((crc >> (8 * i)) & 0xFFU);
    }
    return use(made);
}

std::vector<Input> seeds() {
    State state;
    state.sequence = 77;
    state.counts = {1, -2, 3, -4, 5, -6};
    Command command;
    command.boot = 7;
    command.sequence = 2;
    command.enable = true;
    command.current_ma = {500, -500, 2000, -2000, 0, 1};
    Info info;
    std::copy_n("SERIAL-1", 8, info.serial.begin());
    std::vector<Input> all;
    for (const std::byte kind : {std::byte{0}, std::byte{1}}) {
        all.push_back(seed(kind, encode(state)));
        all.push_back(seed(kind, encode(command)));
        all.push_back(seed(kind, encode(Query{})));
        all.push_back(seed(kind, encode(info)));
    }
    return all;
}

}  // namespace tact::fuzz
