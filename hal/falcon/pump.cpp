#include "hal/falcon/pump.hpp"

#include <algorithm>
#include <cstdlib>

namespace tact::falcon {

using phantom::AmplifierState;

namespace {

constexpr std::array<std::uint16_t, 6> kMost{kTorqueMax, kTorqueMax, kTorqueMax, 0, 0, 0};

}  // namespace

std::uint64_t PumpCounts::bad() const noexcept {
    std::uint64_t n = late + unasked + far;
    for (const std::uint64_t r : refused) n += r;
    return n;
}

std::string summary(const PumpCounts& c) {
    return "requests " + std::to_string(c.asked) + ", replies " + std::to_string(c.taken) + ", late " +
           std::to_string(c.late) + ", unrequested " + std::to_string(c.unasked) + "; refused: frame " +
           std::to_string(c.refused[1]) + ", digits " + std::to_string(c.refused[2]) + ", bits " +
           std::to_string(c.refused[3]) + ", counts too far " + std::to_string(c.far) + "; jumps " +
           std::to_string(c.jumps) + ", transfers failed " + std::to_string(c.transfers_failed) +
           ", stalls " + std::to_string(c.stalls) + ", connected again " + std::to_string(c.reconnects);
}

Pump::Pump(usb::Bus& bus, std::string serial, double rad_per_count)
    : link_(bus, std::move(serial)),
      boot_(bus),
      counts_per_s_(kLegRadS / rad_per_count),
      amplifier_(0, kMost) {}

std::uint32_t Pump::us() noexcept {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_ns(link_.bus().now())) / 1000U);
}

usb::BusFinding Pump::open() {
    usb::BusFinding found = link_.open();
    if (found.fault == usb::BusFault::none) connected(link_.bus().now(), false);
    return found;
}

void Pump::connected(Instant now, bool anew) noexcept {
    news_.link = Link::starting;
    news_.boot_fault = BootFault::none;
    news_.reply.homed = 0;
    news_.on = news_.tripped = false;
    sending_ = due_ = known_ = moved_ = false;
    owed_ = unanswered_ = far_ = 0;
    amplifier_ = phantom::Amplifier(0, kMost);  // off: enable must first be low
    sequence_ = 0;
    boot_.start(now, anew);
    publish(news_);
}

void Pump::lose(Instant now) noexcept {
    link_.lose(now);
    news_.link = Link::closed;
    news_.reply.homed = 0;
    news_.on = news_.tripped = false;
    sending_ = moved_ = false;
}

bool Pump::quiet() const noexcept { return news_.link != Link::open || (!moved_ && !sending_); }

Duration Pump::patience() const noexcept {
    constexpr Duration kLong = std::chrono::milliseconds(1);  // period of the watchdog check
    if (news_.link != Link::open || owed_ > 0) return kLong;
    const Instant now = link_.bus().now();
    const Duration since = now - ordered_at(), idle = asked_at_ + kIdle - now;
    const bool still = since > 20 * interval();  // the servo
    return std::clamp(still ? idle : std::min(idle, interval() - since), kPoll, kLong);
}

void Pump::follow_boot(Instant now) noexcept {
    boot_.round(now);
    news_.boot_fault = boot_.fault();
    if (boot_.state() == BootState::failed) {
        news_.link = Link::refused;
        restart_at_ = now + 10 * kReopenEvery;  // then the whole boot starts again
        return;
    }
    if (boot_.state() != BootState::done) return;
    news_.link = Link::open;
    ++news_.generation;
    stream_.reset();
    owed_ = 0;
    asked_at_ = taken_at_ = now;
    news_.delay_ns = answers_ns_ = sent_answers_ns_ = last_answers_ns_ = 0;
}

void Pump::apply(bool enable, std::uint32_t heartbeat, const Torque3& torque) noexcept {
    phantom::Command c;
    c.sequence = ++sequence_;
    c.heartbeat = heartbeat;
    c.enable = enable;
    std::copy(torque.begin(), torque.end(), c.current_ma.begin());
    static_cast<void>(amplifier_.receive(phantom::encode(c), us()));
}

void Pump::take_order(Instant now) noexcept {
    if (const std::uint32_t relaxed = this->relaxed(); relaxed != relaxed_seen_) {
        relaxed_seen_ = relaxed;
        apply(false, 0, {});
        due_ = true;
    }
    PumpOrder order;
    if (!fetch(order, now)) return;
    if (order.generation != news_.generation || order.relaxed != relaxed_seen_) return;
    apply(order.enable, order.heartbeat, order.torque);
    answers_ns_ = order.answers_ns;
    due_ = true;
}

Torque3 Pump::torque() const noexcept {
    Torque3 out{};
    if (amplifier_.state() == AmplifierState::on && homed())
        std::copy_n(amplifier_.current_ma().begin(), 3, out.begin());
    return out;
}

void Pump::send_due(Instant now) noexcept {
    amplifier_.tick(us(), 0);
    take_order(now);
    news_.on = amplifier_.state() == AmplifierState::on;
    news_.tripped = amplifier_.state() == AmplifierState::tripped;
    const Torque3 torque = this->torque();
    const bool zero = torque == Torque3{};
    const bool urgent = moved_ && zero && owed_ < 2;
    const bool free = owed_ == 0 && (due_ || now - asked_at_ >= kIdle);
    if (sending_ || (!urgent && !free)) return;
    const std::uint8_t colour = !homed() ? led::kRed : news_.on ? led::kGreen : led::kBlue;
    if (!link_.bus().send(encode(Request{torque, colour, true}))) return;
    sending_ = true;
    due_ = false;
    moved_ = !zero;
    asked_at_ = now;
    ++owed_;
    ++news_.counts.asked;
    sent_answers_ns_ = answers_ns_;
    answers_ns_ = 0;
}

void Pump::look_at_replies(Instant now) noexcept {
    if (owed_ == 0 || now - asked_at_ < kReplyMax) return;
    ++news_.counts.late;
    owed_ = 0;
    stream_.reset();
    sent_answers_ns_ = last_answers_ns_ = 0;
    // Replies that arrive now belong to requests that are too old.
    if (!link_.bus().control(ftdi::kForgetIn) || ++unanswered_ >= kUnansweredMax) lose(now);
}

// Before homing, counts are meaningless; they jump when homing completes.
bool Pump::possible(const Reply& reply, Instant at) const noexcept {
    if (reply.homed != kHomedAll) return true;
    const double dt_s = std::clamp(to_s(at - taken_at_), 0.0, 0.1);
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(int{reply.counts[i]}) > kCountMax) return false;
        const int way = std::abs(reply.counts[i] - news_.reply.counts[i]);
        if (known_ && homed() && way > counts_per_s_ * dt_s + 2.0) return false;
    }
    return true;
}

void Pump::take_reply(Reply reply, Instant at) noexcept {
    if (owed_ == 0) {
        ++news_.counts.unasked;
        return;
    }
    --owed_;
    unanswered_ = 0;
    if (last_answers_ns_ != 0) news_.delay_ns = std::max<std::int64_t>(to_ns(at) - last_answers_ns_, 0);
    last_answers_ns_ = sent_answers_ns_;
    sent_answers_ns_ = 0;
    if (doubted_ && reply.homed == kHomedAll)
        reply.homed = 0;
    else
        doubted_ = false;
    if (!possible(reply, at)) {
        ++news_.counts.far;
        if (++far_ < kFarMax) return;
        ++news_.counts.jumps;
        ++news_.jumps;
        doubted_ = true;
        connected(at, true);
        return;
    }
    far_ = 0;
    known_ = true;
    taken_at_ = std::max(at, taken_at_);
    news_.reply = reply;
    news_.taken_at_ns = to_ns(taken_at_);
    ++news_.replies;
    ++news_.counts.taken;
}

void Pump::take_bytes(std::span<const std::byte> bytes, Instant at) noexcept {
    if (news_.link == Link::starting) return boot_.take(bytes, at);
    Reply reply;
    for (const std::byte b : bytes) {
        if (news_.link == Link::open && stream_.push(b, reply)) take_reply(reply, at);
    }
    if (stream_.counts().refused == news_.counts.refused) return;
    news_.counts.refused = stream_.counts().refused;
    owed_ = 0;  // a bad reply also answers the request: ask again at once
    sent_answers_ns_ = last_answers_ns_ = 0;
}

void Pump::take(const usb::BusEvent& event) noexcept {
    if (news_.link == Link::closed) return;
    switch (event.kind) {
        case usb::BusEventKind::packet:
            return take_bytes(
                std::span(event.bytes).first(std::min<std::size_t>(event.size, event.bytes.size())),
                event.at);
        case usb::BusEventKind::sent:
            sending_ = false;
            return;
        case usb::BusEventKind::send_failed:
            sending_ = false;
            moved_ = true;  // the motors' torque is unknown: send the next zero again
            ++news_.counts.transfers_failed;
            return;
        case usb::BusEventKind::receive_failed:
            ++news_.counts.transfers_failed;
            return;
        case usb::BusEventKind::stalled:
            ++news_.counts.stalls;
            sending_ = false;
            return;
        case usb::BusEventKind::gone:
            return lose(event.at);
    }
}

void Pump::round(Duration patience) noexcept {
    const Instant now = link_.bus().now();
    if (news_.link == Link::closed && link_.reopen(now)) {
        ++news_.counts.reconnects;
        connected(now, false);
    }
    if (news_.link == Link::refused && now >= restart_at_) lose(now);
    if (news_.link == Link::starting) follow_boot(now);
    if (news_.link == Link::open) send_due(now);
    const bool stalled = link_.drain(patience, [this](const usb::BusEvent& event) { take(event); });
    if (stalled && news_.link != Link::closed && !link_.bus().clear_stall()) lose(link_.bus().now());
    const Instant after = link_.bus().now();
    if (news_.link == Link::starting) follow_boot(after);
    if (news_.link == Link::open) look_at_replies(after);
    if (news_.link == Link::open) send_due(after);
    if (seconds_.over(after, news_.counts.bad(), news_.counts.taken)) news_.last_second_bad = seconds_.bad();
    publish(news_);
}

}  // namespace tact::falcon
