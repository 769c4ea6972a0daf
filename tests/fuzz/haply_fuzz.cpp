// Bytes from any process that answers in place of the Inverse Service: handshake, frames, messages. The input is the
// stream; its first byte is the size of the pieces in which it arrives.
#include <algorithm>

#include "hal/haply/inverse_messages.hpp"
#include "hal/haply/ws_frames.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/fake_inverse.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const std::size_t piece = 1 + static_cast<std::size_t>(input[0]);
    std::string_view rest(reinterpret_cast<const char*>(input.data()) + 1, input.size() - 1);
    std::size_t used = 0;
    const haply::ReadResult accepted = haply::check_handshake(rest, used);
    require(accepted != haply::ReadResult::message || used <= rest.size());
    haply::FrameReader reader;
    haply::Opcode opcode{};
    std::string payload;
    bool any = false;
    while (!rest.empty()) {
        const std::size_t n = std::min(piece, rest.size());
        if (!reader.feed(rest.substr(0, n))) break;
        rest.remove_prefix(n);
        while (reader.next(opcode, payload) == haply::ReadResult::message) {
            require(payload.size() <= haply::kMessageMax);
            const auto state = haply::parse(payload, "");
            if (!state) continue;
            any = true;
            require(!state->posed || state->at_m.allFinite());
            require(!state->turn || std::abs(state->turn->norm() - 1.0) < 1e-6);
            require(state->ids.size() <= 16 && state->buttons < 8);
            require(!state->found || haply::plain_id(state->id));
        }
    }
    return any;
}

std::vector<Input> seeds() {
    FakeInverse service;
    service.grip = service.second = true;
    const auto seed = [](char piece, const std::string& text) {
        Input out{static_cast<std::byte>(piece)};
        for (const char c : text) out.push_back(static_cast<std::byte>(c));
        return out;
    };
    const std::string full = service.state(true), state = service.state(false);
    return {seed(9, server_frame(haply::Opcode::text, full) + server_frame(haply::Opcode::ping, "p") +
                        server_frame(haply::Opcode::text, state)),
            seed('\x7F', server_frame(haply::Opcode::text, full.substr(0, 50), false) +
                             server_frame(haply::Opcode::continuation, full.substr(50)))};
}

}  // namespace tact::fuzz
