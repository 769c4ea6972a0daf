#include "hal/polhem/polhem_bus.hpp"

#include <algorithm>

namespace tact::polhem {

using usb::BusEvent;
using usb::BusEventKind;
using usb::BusFault;
using usb::BusFinding;

namespace {

constexpr std::array<std::uint16_t, 6> kMaxMa{
    PolhemBus::kCurrentMaxMa, PolhemBus::kCurrentMaxMa, PolhemBus::kCurrentMaxMa, 0, 0, 0};
constexpr std::size_t kReportsMax = 4;  // read in one wait()

template <std::size_t N>
std::array<char, N> chars(const std::string& text) noexcept {
    std::array<char, N> out{};
    for (std::size_t i = 0; i < std::min(N, text.size()); ++i)
        out[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    return out;
}

}  // namespace

PolhemBus::PolhemBus(std::unique_ptr<HidPort> port) : port_(std::move(port)), amplifier_(0, kMaxMa) {}

PolhemBus::~PolhemBus() { close(); }

std::uint32_t PolhemBus::us() noexcept {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_ns(port_->now())) / 1000U);
}

BusFinding PolhemBus::open(const std::string& serial) {
    close();
    const BusFinding found = port_->open(serial);
    if (found.fault != BusFault::none) return found;
    serial_ = found.serial;
    ++boot_;  // the counts are not valid across a connect: the board may have lost its power
    amplifier_ = phantom::Amplifier(boot_, kMaxMa);
    counts32_.reset();
    sequence_ = 0;
    fails_ = 0;
    events_.clear();
    open_ = true;
    return found;
}

void PolhemBus::close() noexcept {
    if (open_) static_cast<void>(port_->write(encode(OutReport{})));
    open_ = moved_ = false;
    port_->close();
    events_.clear();
}

void PolhemBus::push(BusEventKind kind, std::span<const std::byte> bytes) noexcept {
    events_.push(kind, port_->now(), bytes);
}

void PolhemBus::answer() noexcept {
    phantom::Info info;
    info.boot = boot_;
    info.serial = chars<16>(serial_);
    info.model = chars<16>("Haptikfabriken");
    info.current_ma_max = kMaxMa;
    push(BusEventKind::packet, encode(info));
}

bool PolhemBus::tell() noexcept {
    OutReport out;
    std::copy_n(amplifier_.current_ma().begin(), 3, out.current_ma.begin());
    const bool told = port_->write(encode(out));
    ++(told ? counts_.written : counts_.write_failed);
    fails_ = told ? 0 : fails_ + 1;
    if (told) moved_ = out.current_ma != std::array<std::int16_t, 3>{};
    return told;
}

// The watchdog, and zero currents as soon as the amplifier is off for any reason.
void PolhemBus::guard() noexcept {
    amplifier_.tick(us(), 0);
    if (moved_ && amplifier_.state() != phantom::AmplifierState::on) static_cast<void>(tell());
    if (fails_ < kWriteFailsMax) return;
    port_->close();
    open_ = false;
    push(BusEventKind::gone);
}

bool PolhemBus::send(std::span<const std::byte> packet) noexcept {
    if (!open_) return false;
    phantom::Query query;
    if (decode(packet, query) == phantom::PacketFault::none) {
        answer();
        push(BusEventKind::sent);
        return true;
    }
    static_cast<void>(amplifier_.receive(packet, us()));
    push(tell() ? BusEventKind::sent : BusEventKind::send_failed);
    return true;
}

void PolhemBus::take(std::span<const std::byte> bytes) noexcept {
    InReport in;
    if (!decode(bytes, in)) {
        ++counts_.refused;
        return;
    }
    ++counts_.reports;
    phantom::State s;
    s.sequence = ++sequence_;
    // Two reports from the queue still get increasing times.
    const std::uint32_t now_us = us();
    s.time_us = sequence_ > 1 && static_cast<std::int32_t>(now_us - time_us_) <= 0 ? time_us_ + 1 : now_us;
    time_us_ = s.time_us;
    s.command_seen = amplifier_.command_seen();
    s.counts = counts32_.push(in.encoder);
    s.current_ma = amplifier_.current_ma();
    s.status = amplifier_.status();
    s.inputs = in.info & phantom::input::kButtons;
    s.boot = boot_;
    s.commands_refused = amplifier_.refused();
    push(BusEventKind::packet, encode(s));
}

std::size_t PolhemBus::wait(std::span<BusEvent> events, Duration patience) noexcept {
    if (open_) guard();
    // The watchdog is checked every millisecond, however long the caller would wait.
    Duration left =
        !events_.empty() ? Duration{0} : std::min<Duration>(patience, std::chrono::milliseconds(1));
    std::array<std::byte, kReportBytesMax + 1> bytes{};
    if (!open_) static_cast<void>(port_->read({}, left));  // waits
    for (std::size_t n = 0; open_ && n < kReportsMax; ++n) {
        const int size = port_->read(bytes, left);
        left = Duration{0};
        if (size == 0) break;
        if (size == kPortGone) {
            port_->close();
            open_ = false;
            push(BusEventKind::gone);
            break;
        }
        take(std::span(bytes).first(std::min<std::size_t>(static_cast<std::size_t>(size), bytes.size())));
    }
    if (open_) guard();
    return events_.fetch(events);
}

}  // namespace tact::polhem
