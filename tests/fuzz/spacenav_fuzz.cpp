// What arrives from spacenavd's socket. The first byte: size of the portions in which the bytes arrive.
#include "ipc/spacenav/spacenav_stream.hpp"

#include <algorithm>
#include <cstdlib>

#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const std::size_t portion = std::max<std::size_t>(std::to_integer<std::size_t>(input[0]), 1);
    std::span<const std::byte> rest = input.subspan(1);
    const std::size_t packets = rest.size() / SpacenavStream::kPacketBytes;
    SpacenavStream stream, whole;
    whole.add(rest);
    while (!rest.empty()) {
        const std::size_t n = std::min(portion, rest.size());
        stream.add(rest.first(n));
        rest = rest.subspan(n);
        const SpacenavState& s = stream.state();
        for (const std::int32_t axis : s.axes)
            require(axis >= -SpacenavState::kAxisMost && axis <= SpacenavState::kAxisMost);
        require(s.type >= 0 && s.type <= 0xffff && s.device <= SpacenavDevice::present);
        if (s.device == SpacenavDevice::absent || stream.lost())
            require(s.buttons == 0 && s.axes == SpacenavState{}.axes);
        require((s.buttons & ~s.pressed) == 0);  // nothing is held that was not pressed
    }
    // The portions make no difference.
    const SpacenavState &a = stream.state(), &b = whole.state();
    require(a.axes == b.axes && a.buttons == b.buttons && a.device == b.device && a.refused == b.refused &&
            stream.lost() == whole.lost());
    require(a.events + a.refused <= packets && (stream.lost() || a.events + a.refused == packets));
    return a.events > 0;
}

std::vector<Input> seeds() {
    using Packet = SpacenavStream::Packet;
    const Packet motion{0, 350, -350, 1, 2, 3, -4, 16}, press{1, 0, 0, 0, 0, 0, 0, 0},
        other{1, 31, 0, 0, 0, 0, 0, 0}, release{2, 0, 0, 0, 0, 0, 0, 0}, leaves{3, 1, 0, 0, 0, 0, 0, 0},
        arrives{3, 0, 0, 0, 0, 0, 0, 0};
    Packet type = SpacenavStream::device_type_request(), none = type, name = type;
    type[1] = 0x20a;
    none[7] = -1;
    name[0] -= 5;
    std::vector<Input> all;
    for (const std::uint8_t portion :
         {std::uint8_t{1}, std::uint8_t{7}, std::uint8_t{32}, std::uint8_t{255}}) {
        Input work{static_cast<std::byte>(portion)}, comes = work;
        for (const Packet& p : {type, motion, press, other, motion, release, leaves, none})
            for (const std::byte b : bytes_of(p)) work.push_back(b);
        for (const Packet& p :
             {none, arrives, type, name, press, motion, Packet{4, 0, 0, 0, 0, 0, 0, 0}, motion})
            for (const std::byte b : bytes_of(p)) comes.push_back(b);
        all.insert(all.end(), {work, comes});
    }
    return all;
}

}  // namespace tact::fuzz
