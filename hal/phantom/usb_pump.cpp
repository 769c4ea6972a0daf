#include "hal/phantom/usb_pump.hpp"

#include <algorithm>
#include <cstring>

namespace tact::phantom {

namespace {

constexpr unsigned kUnansweredMax = 10;

std::string text(const std::array<char, 16>& chars) {
    return {chars.begin(), std::find(chars.begin(), chars.end(), '\0')};
}

// What no board can mean: rates that no bus carries, a watchdog that is none.
bool possible(const Info& i, Duration watchdog_max) noexcept {
    return i.rate_hz >= 100 && i.rate_hz <= 8000 && i.watchdog_ms >= 1 &&
           std::chrono::milliseconds(i.watchdog_ms) <= watchdog_max;
}

}  // namespace

std::uint64_t PumpCounts::bad() const noexcept {
    std::uint64_t n = repeated + stale + clock + restarted + lost;
    for (const std::uint64_t r : refused) n += r;
    return n;
}

std::string summary(const PumpCounts& c) {
    constexpr std::array<const char*, kPacketFaults> kNames{"",     "size",     "magic",    "version",
                                                            "kind", "checksum", "reserved", "text"};
    std::string refused;
    for (std::size_t i = 1; i < kPacketFaults; ++i) {
        if (c.refused[i] > 0)
            refused +=
                (refused.empty() ? "" : ", ") + std::to_string(c.refused[i]) + " for their " + kNames[i];
    }
    return "asked " + std::to_string(c.asked) + " times, answered " + std::to_string(c.answered) +
           "; states taken " + std::to_string(c.taken) + ", before an answer " + std::to_string(c.early) +
           "; packets refused: " + (refused.empty() ? "none" : refused) + "; transfers failed " +
           std::to_string(c.transfers_failed) + ", stalls " + std::to_string(c.stalls) +
           ", connected again " + std::to_string(c.reconnects);
}

BusFinding UsbPump::open() {
    BusFinding found = bus_.open(serial_);
    if (found.fault == BusFault::none) {
        if (serial_.empty()) serial_ = found.serial;  // from now on this one
        connected(bus_.now());
    }
    return found;
}

void UsbPump::connected(Instant now) noexcept {
    news_.link = Link::asking;
    news_.refusal = LinkRefusal::none;
    known_ = sending_ = relax_sending_ = stalled_ = false;
    query_due_ = true;
    unanswered_ = 0;
    heard_at_ = asked_at_ = now;
    relaxed_sent_ = relaxed();  // whatever was on is off: the board lost its link or is new
    publish();
}

void UsbPump::reopen(Instant now) noexcept {
    if (now < retry_at_) return;
    retry_at_ = now + kReopenEvery;
    BusFinding found;
    try {
        found = bus_.open(serial_);
    } catch (...) {
        return;  // out of memory for a moment: tried again
    }
    if (found.fault != BusFault::none) return;
    ++news_.counts.reconnects;
    connected(now);
}

void UsbPump::lose(Instant now) noexcept {
    bus_.close();
    news_.link = Link::closed;
    sending_ = relax_sending_ = known_ = false;
    retry_at_ = now + kReopenEvery;
}

void UsbPump::close() noexcept { bus_.close(); }

bool UsbPump::quiet() const noexcept {
    return news_.link == Link::closed || news_.link == Link::refused ||
           (relaxed_sent_ == relaxed() && !sending_);
}

Duration UsbPump::patience() const noexcept {
    constexpr Duration kLong = std::chrono::milliseconds(5);
    if (news_.link != Link::open) return kLong;
    const Duration since = bus_.now() - instant_from_ns(written_at_ns_);
    const Duration interval(interval_ns_);
    if (since > 20 * interval) return std::chrono::milliseconds(1);  // the servo stands still
    return std::clamp(interval - since, kPoll, kLong);
}

void UsbPump::send(const Command& command, const PumpOrder& order) noexcept {
    if (!bus_.send(encode(command))) return;
    sending_ = true;
    sent_[command.sequence % kRing] = {command.sequence, order.state_us, command.enable, order.state_us != 0,
                                       command.current_ma};
    sequence_ = command.sequence;
    heartbeat_ = command.heartbeat;
    ++news_.counts.sent;
}

void UsbPump::send_due(Instant now) noexcept {
    if (sending_ || news_.link == Link::closed || news_.link == Link::refused) return;
    if (query_due_) {
        if (!bus_.send(encode(Query{}))) return;
        sending_ = true;
        query_due_ = false;
        asked_at_ = now;
        ++news_.counts.asked;
        return;
    }
    if (news_.link != Link::open) return;
    Command c;
    c.sequence = sequence_ + 1;
    c.boot = news_.info.boot;
    if (relaxed_sent_ != relaxed()) {
        relax_wanted_ = relaxed();
        c.heartbeat = heartbeat_ + 1;
        send(c, {});
        relax_sending_ = sending_;
        return;
    }
    PumpOrder order;
    const std::uint64_t written = mail_->order.count();
    if (written == orders_seen_ || !mail_->order.read(order)) return;
    orders_seen_ = written;
    const std::int64_t passed = order.written_at_ns - written_at_ns_;
    if (passed > 0) interval_ns_ = std::clamp<std::int64_t>(passed, 50'000, 2'000'000);
    written_at_ns_ = order.written_at_ns;
    if (order.generation != news_.generation || order.relaxed != relaxed()) return;
    c.heartbeat = order.heartbeat;
    c.enable = order.enable;
    if (order.enable) c.current_ma = order.current_ma;
    send(c, order);
}

void UsbPump::take_info(const Info& info, Instant at) noexcept {
    ++news_.counts.answered;
    if (news_.link != Link::asking) return;  // an answer to a question asked twice
    heard_at_ = at;
    unanswered_ = 0;
    const bool same_serial = serial_.empty() || text(info.serial) == serial_;
    news_.refusal = common_version(Query{}, info) != kVersion ? LinkRefusal::version
                    : !same_serial                            ? LinkRefusal::serial
                    : !possible(info, watchdog_max_)          ? LinkRefusal::figures
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

// What the board says of the commands: which it has, and how far it is behind.
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
    if (!known_) {  // from before this program: who it is comes first
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

void UsbPump::take_packet(const BusEvent& event) noexcept {
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
    // Info speaks version 0: what was refused for that was refused as a state.
    const bool was_info = fault == PacketFault::version && other != PacketFault::version;
    ++news_.counts.refused[static_cast<std::size_t>(was_info ? other : fault)];
}

void UsbPump::take(const BusEvent& event) noexcept {
    if (news_.link == Link::closed) return;
    switch (event.kind) {
        case BusEventKind::packet:
            return take_packet(event);
        case BusEventKind::sent:
            if (relax_sending_) relaxed_sent_ = relax_wanted_;
            sending_ = relax_sending_ = false;
            return;
        case BusEventKind::send_failed:
            sending_ = relax_sending_ = false;
            ++news_.counts.transfers_failed;
            return;
        case BusEventKind::receive_failed:
            ++news_.counts.transfers_failed;
            return;
        case BusEventKind::stalled:
            ++news_.counts.stalls;
            sending_ = relax_sending_ = false;
            stalled_ = true;
            return;
        case BusEventKind::gone:
            return lose(event.at);
    }
}

void UsbPump::count_second(Instant now) noexcept {
    if (now - second_at_ < std::chrono::seconds(1)) return;
    second_at_ = now;
    const std::uint64_t bad = news_.counts.bad() - second_bad_, taken = news_.counts.taken - second_taken_;
    news_.last_second_bad = bad * 20 > bad + taken;
    if (news_.last_second_bad) ++news_.counts.bad_seconds;
    second_bad_ = news_.counts.bad();
    second_taken_ = news_.counts.taken;
}

void UsbPump::publish() noexcept { mail_->news.publish(news_); }

void UsbPump::round(Duration patience) noexcept {
    const Instant now = bus_.now();
    if (news_.link == Link::closed) reopen(now);
    if (news_.link == Link::open && now - heard_at_ > silence_) {
        news_.link = Link::asking;
        query_due_ = true;
        unanswered_ = 0;
    } else if (news_.link == Link::asking && !query_due_ && now - asked_at_ >= kAskEvery) {
        query_due_ = true;
        if (++unanswered_ > kUnansweredMax) lose(now);
    }
    send_due(now);
    for (std::size_t n = 0; n < kBatchesMax; ++n) {
        const std::size_t count =
            std::min(bus_.wait(events_, n == 0 ? patience : Duration{0}), events_.size());
        for (const BusEvent& event : std::span(events_).first(count)) take(event);
        if (count < events_.size()) break;
    }
    if (stalled_) {
        stalled_ = false;
        if (!bus_.clear_stall()) lose(bus_.now());
    }
    send_due(bus_.now());
    count_second(bus_.now());
    publish();
}

}  // namespace tact::phantom
