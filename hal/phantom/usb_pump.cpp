// The link to the board, what is sent over it and when. What comes in is taken in usb_pump_take.cpp.
#include "hal/phantom/usb_pump.hpp"

#include <algorithm>

namespace tact::phantom {

namespace {

constexpr unsigned kUnansweredMax = 10;

}  // namespace

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
    const std::uint64_t written = mailbox_->order.count();
    if (written == orders_seen_ || !mailbox_->order.read(order)) return;
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

void UsbPump::count_second(Instant now) noexcept {
    if (now - second_at_ < std::chrono::seconds(1)) return;
    second_at_ = now;
    const std::uint64_t bad = news_.counts.bad() - second_bad_, taken = news_.counts.taken - second_taken_;
    news_.last_second_bad = bad * 20 > bad + taken;
    if (news_.last_second_bad) ++news_.counts.bad_seconds;
    second_bad_ = news_.counts.bad();
    second_taken_ = news_.counts.taken;
}

void UsbPump::publish() noexcept { mailbox_->news.publish(news_); }

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
