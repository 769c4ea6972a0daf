// The driver with reports from any device with the identifiers of a Haptikfabriken board. The input is a series of
// reports: a byte of size, then that many bytes; size 255: 11 ms of silence.
#include <algorithm>
#include <array>
#include <memory>

#include "hal/polhem/polhem_bus.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

class Port final : public polhem::HidPort {
public:
    explicit Port(std::span<const std::byte> input) : input_(input) {}
    usb::BusFinding open(const std::string& /*serial*/) override { return {usb::BusFault::none, "F", {}}; }
    void close() noexcept override {}
    int read(std::span<std::byte> into, Duration /*patience*/) noexcept override {
        now_ += std::chrono::microseconds(100);
        if (input_.empty()) return polhem::kPortGone;
        const auto size = static_cast<std::size_t>(input_[0]);
        input_ = input_.subspan(1);
        if (size == 255) now_ += std::chrono::milliseconds(11);
        const std::size_t n = std::min({size, input_.size(), into.size()});
        if (size == 255 || n == 0) return 0;
        std::copy_n(input_.begin(), n, into.begin());
        input_ = input_.subspan(n);
        return static_cast<int>(n);
    }
    bool write(std::span<const std::byte> report) noexcept override {
        polhem::OutReport out;
        require(polhem::decode(report, out) && out.command == 0);
        for (const std::int16_t ma : out.current_ma) {
            require(ma >= -int{polhem::PolhemBus::kCurrentMaxMa} &&
                    ma <= int{polhem::PolhemBus::kCurrentMaxMa});
        }
        shown = out.current_ma != std::array<std::int16_t, 3>{};
        return true;
    }
    Instant now() noexcept override { return now_; }

    bool shown = false;

private:
    std::span<const std::byte> input_;
    Instant now_ = instant_from_ns(1'000'000'000);
};

}  // namespace

bool run(std::span<const std::byte> input) {
    auto made = std::make_unique<Port>(input);
    Port& port = *made;
    polhem::PolhemBus bus(std::move(made));
    static_cast<void>(bus.open(""));
    phantom::Command c;
    c.boot = 1;
    bool any = false, gone = false;
    std::uint32_t sequence = 0;
    for (std::size_t n = 0; !gone && n <= input.size(); ++n) {
        c.enable = n > 0;
        c.current_ma.fill(n % 2 == 0 ? 30000 : -500);
        // The servo pauses from time to time.
        if (n % 16 < 12) {
            ++c.sequence;
            ++c.heartbeat;
            bus.send(phantom::encode(c));
        }
        std::array<usb::BusEvent, 8> events;
        const std::size_t got = bus.wait(events, Duration{0});
        for (const usb::BusEvent& e : std::span(events).first(got)) {
            gone = gone || e.kind == usb::BusEventKind::gone;
            if (e.kind != usb::BusEventKind::packet) continue;
            phantom::State s;
            require(decode(std::span(e.bytes).first(e.size), s) == phantom::PacketFault::none);
            require(s.sequence > sequence);
            sequence = s.sequence;
            any = true;
        }
    }
    bus.close();
    require(gone || !port.shown);
    return any;
}

std::vector<Input> seeds() {
    Input steady, torn;
    polhem::InReport in;
    for (std::int16_t i = 0; i < 40; ++i) {
        in.encoder.fill(static_cast<std::int16_t>(i * 900));
        const auto report = polhem::encode(in);
        steady.push_back(std::byte{polhem::kReportBytes});
        steady.insert(steady.end(), report.begin(), report.end());
        torn.push_back(i % 3 == 0 ? std::byte{255} : std::byte{polhem::kReportBytes});
        if (i % 3 != 0) torn.insert(torn.end(), report.begin(), report.end());
    }
    return {steady, torn};
}

}  // namespace tact::fuzz
