// The link to the board and the sending of packets. usb_pump_take.cpp handles received packets.
#include "hal/phantom/usb_pump.hpp"

#include <algorithm>

namespace tact::phantom {

namespace {

constexpr unsigned kUnansweredMax = 10;

}  // namespace

usb::BusFinding UsbPump::open() {
    usb::BusFinding found = link_.open();
    if (found.fault == usb::BusFault::none) connected(link_.bus().now());
    return found;
}

void UsbPump::connected(Instant now) noexcept {
    news_.link = Link::asking;
    news_.refusal = LinkRefusal::none;
    known_ = sending_ = relax_sending_ = false;
    query_due_ = true;
    unanswered_ = 0;
    heard_at_ = asked_at_ = now;
    relaxed_sent_ = relaxed();  // everything is off: the board lost its link or is new
    publish(news_);
}

void UsbPump::lose(Instant now) noexcept {
    link_.lose(now);
    news_.link = Link::closed;
    sending_ = relax_sending_ = known_ = false;
}

bool UsbPump::quiet() const noexcept {
    return news_.link == Link::closed || news_.link == Link::refused ||
           (relaxed_sent_ == relaxed() && !sending_);
}

Duration UsbPump::patience() const noexcept {
    constexpr Duration kLong = std::chrono::milliseconds(5);
    if (news_.link != Link::open) return kLong;
    const Duration since = link_.bus().now() - ordered_at();
    if (since > 20 * interval()) return std::chrono::milliseconds(1);  // the servo hangs
    return std::clamp(interval() - since, kPoll, kLong);
}

void UsbPump::send(const Command& command, const PumpOrder& order) noexcept {
    if (!link_.bus().send(encode(command))) return;
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
        if (!link_.bus().send(encode(Query{}))) return;
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
    if (!fetch(order, now)) return;
    if (order.generation != news_.generation || order.relaxed != relaxed()) return;
    c.heartbeat = order.heartbeat;
    c.enable = order.enable;
    if (order.enable) c.current_ma = order.current_ma;
    send(c, order);
}

void UsbPump::count_second(Instant now) noexcept {
    if (!seconds_.over(now, news_.counts.bad(), news_.counts.taken)) return;
    news_.last_second_bad = seconds_.bad();
    if (news_.last_second_bad) ++news_.counts.bad_seconds;
}

void UsbPump::round(Duration patience) noexcept {
    const Instant now = link_.bus().now();
    if (news_.link == Link::closed && link_.reopen(now)) {
        ++news_.counts.reconnects;
        connected(now);
    }
    if (news_.link == Link::open && now - heard_at_ > silence_) {
        news_.link = Link::asking;
        query_due_ = true;
        unanswered_ = 0;
    } else if (news_.link == Link::asking && !query_due_ && now - asked_at_ >= kAskEvery) {
        query_due_ = true;
        if (++unanswered_ > kUnansweredMax) lose(now);
    }
    send_due(now);
    const bool stalled = link_.drain(patience, [this](const usb::BusEvent& event) { take(event); });
    if (stalled && news_.link != Link::closed && !link_.bus().clear_stall()) lose(link_.bus().now());
    send_due(link_.bus().now());
    count_second(link_.bus().now());
    publish(news_);
}

}  // namespace tact::phantom
