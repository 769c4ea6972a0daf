// Reception from the board: acceptance and evaluation of packets.
#include <algorithm>

#include "hal/phantom/usb_pump.hpp"

namespace tact::phantom {

namespace {

// False for impossible values: rates that no bus carries, a useless watchdog.
bool possible(const Info& i, Duration watchdog_max) noexcept {
    return i.rate_hz >= 100 && i.rate_hz <= 8000 && i.watchdog_ms >= 1 &&
           std::chrono::milliseconds(i.watchdog_ms) <= watchdog_max;
}

}  // namespace

void UsbPump::take_info(const Info& info, Instant at) noexcept {
    ++news_.counts.answered;
    if (news_.link != Link::asking) return;  // answer to a repeated query
    heard_at_ = at;
    unanswered_ = 0;
    const bool same_serial = link_.serial().empty() || text_of(info.serial) == link_.serial();
    news_.refusal = common_version(Query{}, info) != kVersion ? LinkRefusal::version
                    : !same_serial                            ? LinkRefusal::serial
                    : !possible(info, watchdog_max_)          ? LinkRefusal::metrics
                                                              : LinkRefusal::none;
    const bool anew = !known_ || info.boot != news_.info.boot;
    news_.info = info;
    if (news_.refusal != LinkRefusal::none) {
        news_.link = Link::refused;
        return;
    }
    news_.link = Link::open;
    known_ = true;
    if (!anew) return;
    ++news_.generation;
    const SequenceGate::Counts& c = gate_.counts();
    before_ = {before_.taken + c.taken, before_.repeated + c.repeated,   before_.stale + c.stale,
               before_.clock + c.clock, before_.restarted + c.restarted, before_.lost + c.lost};
    gate_.reset();
    board_clock_ = TrackerClock(std::chrono::milliseconds(50));
    news_.seen_known = false;
    news_.delay_ns = news_.behind_since_ns = 0;
    seen_ = sequence_;
    board_refused_ = 0;
}

// Evaluates the board's acknowledgement of commands: the newest accepted one and the backlog.
void UsbPump::look_at_seen(Instant at) noexcept {
    const State& s = news_.state;
    const Sent& command = sent_[s.command_seen % kRing];
    const bool known = command.sequence == s.command_seen && command.sequence != 0;
    news_.seen_known = known;
    news_.seen_enable = known && command.enable;
    news_.seen_ma = known ? command.current_ma : std::array<std::int16_t, 6>{};
    if (known && command.answers && s.command_seen != seen_) {
        const std::uint32_t us = s.time_us - command.state_us;
        if (us < 1'000'000U) news_.delay_ns = std::int64_t{us} * 1000;
    }
    seen_ = s.command_seen;
    const auto behind = static_cast<std::int32_t>(sequence_ - s.command_seen);
    const bool far = behind > static_cast<std::int32_t>(kBehindMax);
    if (!far)
        news_.behind_since_ns = 0;
    else if (news_.behind_since_ns == 0)
        news_.behind_since_ns = to_ns(at);
    news_.counts.refused_by_board += static_cast<std::uint8_t>(s.commands_refused - board_refused_);
    board_refused_ = s.commands_refused;
}

void UsbPump::take_state(const State& state, Instant at) noexcept {
    if (!known_) {  // states from before this program: identify the board first
        ++news_.counts.early;
        return;
    }
    const Order order = gate_.check(state.boot, state.sequence, state.time_us);
    const SequenceGate::Counts& c = gate_.counts();
    news_.counts.repeated = before_.repeated + c.repeated;
    news_.counts.stale = before_.stale + c.stale;
    news_.counts.clock = before_.clock + c.clock;
    news_.counts.restarted = before_.restarted + c.restarted;
    news_.counts.lost = before_.lost + c.lost;
    const bool other_boot = order == Order::restarted || state.boot != news_.info.boot;
    if (other_boot && news_.link == Link::open) {
        news_.link = Link::asking;
        query_due_ = true;
    }
    if (order != Order::taken || other_boot) return;
    Instant taken_at = at;
    static_cast<void>(board_clock_.stamp(state.time_us, at, taken_at));
    news_.link = Link::open;
    heard_at_ = at;
    taken_at_ = std::max(taken_at, taken_at_);
    news_.state = state;
    news_.taken_at_ns = to_ns(taken_at_);
    ++news_.states;
    ++news_.counts.taken;
    look_at_seen(at);
}

void UsbPump::take_packet(const usb::BusEvent& event) noexcept {
    if (event.size > event.bytes.size()) {
        ++news_.counts.refused[static_cast<std::size_t>(PacketFault::size)];
        return;
    }
    const std::span<const std::byte> bytes = std::span(event.bytes).first(event.size);
    State state;
    const PacketFault fault = decode(bytes, state);
    if (fault == PacketFault::none) return take_state(state, event.at);
    Info info;
    const PacketFault other = decode(bytes, info);
    if (other == PacketFault::none) return take_info(info, event.at);
    // Info has version 0: a packet refused as a state for its version may be an Info.
    const bool was_info = fault == PacketFault::version && other != PacketFault::version;
    ++news_.counts.refused[static_cast<std::size_t>(was_info ? other : fault)];
}

void UsbPump::take(const usb::BusEvent& event) noexcept {
    if (news_.link == Link::closed) return;
    switch (event.kind) {
        case usb::BusEventKind::packet:
            return take_packet(event);
        case usb::BusEventKind::sent:
            if (relax_sending_) relaxed_sent_ = relax_wanted_;
            sending_ = relax_sending_ = false;
            return;
        case usb::BusEventKind::send_failed:
            sending_ = relax_sending_ = false;
            ++news_.counts.transfers_failed;
            return;
        case usb::BusEventKind::receive_failed:
            ++news_.counts.transfers_failed;
            return;
        case usb::BusEventKind::stalled:
            ++news_.counts.stalls;
            sending_ = relax_sending_ = false;
            return;
        case usb::BusEventKind::gone:
            return lose(event.at);
    }
}

}  // namespace tact::phantom
