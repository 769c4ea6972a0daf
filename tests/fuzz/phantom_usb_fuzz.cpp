// A whole connection of the driver with an arm's board, or any device with its identifiers: any bytes, any size, states of
// any content with a valid checksum, failures of the bus, in any order. No current may exceed the limits or flow
// without enable, and every pose is finite.
#include "hal/phantom/phantom_usb.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/fuzz_usb_bus.hpp"

namespace tact::fuzz {
namespace {

using namespace tact::phantom;
using usb::BusEventKind;

Info info() {
    Info i;
    i.boot = 7;
    i.serial = {'F'};
    i.current_ma_max = {2000, 2000, 2000, 0, 0, 0};
    return i;
}

class FuzzBus final : public FuzzUsbBus {
public:
    bool send(std::span<const std::byte> packet) noexcept override {
        Command c;
        Query q;
        if (decode(packet, q) == PacketFault::none) {
            push(BusEventKind::packet, encode(info()));
            push(BusEventKind::packet, encode(next()));
        } else {
            require(decode(packet, c) == PacketFault::none);
            for (std::size_t i = 0; i < 6; ++i) {
                const int most = c.enable ? info().current_ma_max[i] : 0;
                require(c.current_ma[i] >= -most && c.current_ma[i] <= most);
            }
            seen = c.sequence;
        }
        push(BusEventKind::sent);
        return true;
    }

    State next() {
        State s;
        s.sequence = ++sequence;
        s.time_us = static_cast<std::uint32_t>(to_ns(time) / 1000) + sequence;
        s.boot = 7;
        s.status = status::kCalibrated;
        s.command_seen = seen;
        return s;
    }
    std::uint32_t sequence = 0, seen = 0;
};

// A valid state with all other fields from the input.
State shaped(FuzzBus& bus, std::span<const std::byte> bytes) {
    State s = bus.next();
    const auto at = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned>(bytes[i]) : 0U; };
    for (std::size_t i = 0; i < 6; ++i) {
        const unsigned shift = at(0) % 25;
        s.counts[i] = static_cast<std::int32_t>((at(1 + i) << shift) - 128U);
        s.current_ma[i] = static_cast<std::int16_t>(static_cast<int>(at(7 + i)) * 64 - 8192);
    }
    s.status = static_cast<std::uint16_t>(at(13) & status::kAll);
    s.inputs = static_cast<std::uint16_t>(at(14) & input::kButtons);
    if (at(15) > 200) s.boot = 8;
    s.command_seen += at(16) % 4;
    s.commands_refused = static_cast<std::uint8_t>(at(17));
    return s;
}

}  // namespace

bool run(std::span<const std::byte> input) {
    PhantomUsbSettings settings;
    settings.thread = false;
    settings.arm.calibration = CalibrationStyle::automatic;
    auto owned = std::make_unique<FuzzBus>();
    FuzzBus& bus = *owned;
    PhantomUsb device(settings, std::move(owned));
    static_cast<void>(device.open());
    DeviceSample sample;
    std::uint64_t heartbeat = 0;
    std::uint64_t taken = 0;
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
                bus.push(BusEventKind::packet, encode(shaped(bus, bytes)));
                break;
            default:  // a series of valid states, so that the calibration completes
                for (unsigned i = 0; i < 8; ++i) bus.push(BusEventKind::packet, encode(bus.next()));
        }
        device.pump().round(Duration{0});
        const Instant now = bus.time;
        const IoStatus status = device.read(sample, now);
        require(sample.T_dev_tool.finite() && sample.twist_dev.linear_m_s.allFinite() &&
                sample.twist_dev.angular_rad_s.allFinite());
        require(sample.taken_at <= now && sample.delay >= Duration{0});
        if (status == IoStatus::ok) ++taken;
        const bool enable = (what & 64U) != 0;
        static_cast<void>(
            device.write({.wrench_dev = {Vec3::Constant(static_cast<double>(length)), Vec3::Zero()},
                          .enable = enable,
                          .heartbeat = ++heartbeat},
                         now));
        if ((what & 128U) != 0) device.relax();
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
    std::vector<Input> all(3);
    for (unsigned i = 0; i < 80; ++i)
        record(all[0], i < 70 ? 4 : 4 + 64, 10, {});  // first calibrated, then enabled
    all[1] = all[0];
    const std::array<std::byte, 18> shape{std::byte{3}, std::byte{130}, std::byte{120}, std::byte{128}};
    for (unsigned i = 0; i < 20; ++i) record(all[1], 2 + 64, 10, shape);
    for (unsigned i = 0; i < 6; ++i) {
        record(all[2], 1 + 8 * i, 10, shape);
        record(all[2], 4, 10, {});
    }
    return all;
}

}  // namespace tact::fuzz
