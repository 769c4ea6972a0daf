// A whole connection with a Falcon, or any device with its identifiers: bytes of any content, size and time, and failures
// of the bus. No torque may exceed the motors' limits or be sent before homing or without enable, and every pose is
// finite.
#include "hal/falcon/falcon.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/fuzz_usb_bus.hpp"

namespace tact::fuzz {
namespace {

using falcon::Reply;
using usb::BusEventKind;

class FuzzBus final : public FuzzUsbBus {
public:
    bool send(std::span<const std::byte> packet) noexcept override {
        falcon::Request r;
        require(decode(packet, r) == falcon::PacketFault::none);  // the firmware runs, so it is never loaded
        const bool zero = r.torque == falcon::Torque3{};
        for (const std::int16_t t : r.torque) require(t >= -falcon::kTorqueMax && t <= falcon::kTorqueMax);
        require(zero || (may_push && r.leds == falcon::led::kGreen));
        push(BusEventKind::sent);
        if (!opened) push(BusEventKind::packet, encode(Reply{}));
        asked = true;
        return true;
    }

    bool opened = false, asked = false, may_push = false;
};

// A valid reply with all fields from the input.
Reply shaped(std::span<const std::byte> bytes) {
    const auto at = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned>(bytes[i]) : 0U; };
    Reply r;
    for (std::size_t i = 0; i < 3; ++i) {
        const unsigned shift = at(0) % 9;
        r.counts[i] =
            static_cast<std::int16_t>(static_cast<std::uint16_t>((at(1 + i) << shift) - (128U << shift)));
    }
    r.homed = static_cast<std::uint8_t>(at(4) > 20 ? falcon::kHomedAll : at(4) % 8);
    r.buttons = static_cast<std::uint8_t>(at(5) % 16);
    return r;
}

}  // namespace

bool run(std::span<const std::byte> input) {
    FalconSettings settings;
    settings.thread = false;
    auto owned = std::make_unique<FuzzBus>();
    FuzzBus& bus = *owned;
    Falcon device(settings, std::move(owned));
    static_cast<void>(device.open());
    bus.opened = true;
    DeviceSample sample;
    std::uint64_t heartbeat = 0, taken = 0;
    // Of a record: its kind, the number of bytes that follow, the time that passes.
    while (input.size() >= 3 && heartbeat < 2000) {
        const auto what = static_cast<unsigned>(input[0]);
        const auto length = std::min<std::size_t>(static_cast<std::size_t>(input[1]), input.size() - 3);
        bus.time += std::chrono::microseconds(100 * static_cast<int>(input[2]));
        const auto bytes = input.subspan(3, length);
        input = input.subspan(3 + length);
        switch (what % 8) {
            case 0:
                bus.push(BusEventKind::packet, bytes);
                break;
            case 1:
                bus.push(static_cast<BusEventKind>(what / 8 % 6), bytes);
                break;
            case 2:
            case 3:
                bus.push(BusEventKind::packet, encode(shaped(bytes)));
                break;
            default:
                bus.push(BusEventKind::packet, encode(Reply{{}, 0, falcon::kHomedAll}));
        }
        device.pump().round(Duration{0});
        const Instant now = bus.time;
        const IoStatus status = device.read(sample, now);
        require(sample.T_dev_tool.finite() && sample.twist_dev.linear_m_s.allFinite());
        require(sample.T_dev_tool.p_m.norm() <= falcon::kReachM);
        require(sample.taken_at <= now && sample.delay >= Duration{0});
        if (status == IoStatus::ok) ++taken;
        const bool enable = (what & 64U) != 0;
        // After enable goes low no torque is allowed, and 10 ms after the last order none either.
        bus.may_push = enable || bus.may_push;
        static_cast<void>(
            device.write({.wrench_dev = {Vec3::Constant(static_cast<double>(length)), Vec3::Zero()},
                          .enable = enable,
                          .heartbeat = ++heartbeat},
                         now));
        if ((what & 128U) != 0) device.relax();
        if (!enable || (what & 128U) != 0) bus.may_push = false;
        device.pump().round(Duration{0});
    }
    return taken > 0;
}

std::vector<Input> seeds() {
    const auto record = [](Input& to, unsigned what, unsigned time, std::span<const std::byte> bytes) {
        to.push_back(static_cast<std::byte>(what));
        to.push_back(static_cast<std::byte>(bytes.size()));
        to.push_back(static_cast<std::byte>(time));
        to.insert(to.end(), bytes.begin(), bytes.end());
    };
    std::vector<Input> all(4);
    for (unsigned i = 0; i < 80; ++i)
        record(all[0], i < 30 ? 4 : 4 + 64, 10, {});  // first homed, then enabled
    all[1] = all[0];
    const std::array<std::byte, 6> shape{std::byte{3}, std::byte{130}, std::byte{120}, std::byte{128},
                                         std::byte{99}};
    for (unsigned i = 0; i < 20; ++i) record(all[1], 2 + 64, 10, shape);
    for (unsigned i = 0; i < 6; ++i) {
        record(all[2], 1 + 8 * i, 10, shape);
        record(all[2], 4, 10, {});
    }
    all[3] = all[0];
    const auto reply = encode(Reply{{40, -30, 20}, 1, falcon::kHomedAll});
    for (unsigned i = 0; i < 16; ++i) record(all[3], 64, 10, std::span(reply).first(i + 1));
    return all;
}

}  // namespace tact::fuzz
