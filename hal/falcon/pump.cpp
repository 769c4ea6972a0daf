#include "hal/falcon/pump.hpp"

#include <algorithm>
#include <cstdlib>

namespace tact::falcon {

using phantom::AmplifierState;
using phantom::BusEvent;
using phantom::BusEventKind;
using phantom::BusFault;
using phantom::BusFinding;

namespace {

constexpr std::array<std::uint16_t, 6> kMost{kTorqueMax, kTorqueMax, kTorqueMax, 0, 0, 0};

}  // namespace

std::uint64_t PumpCounts::bad() const noexcept {
    std::uint64_t n = late + unasked + far;
    for (const std::uint64_t r : refused) n += r;
    return n;
}

std::string summary(const PumpCounts& c) {
    return "asked " + std::to_string(c.asked) + " times, answered " + std::to_string(c.taken) + ", late " +
           std::to_string(c.late) + ", not asked for " + std::to_string(c.unasked) +
           "; refused for their frame " + std::to_string(c.refused[1]) + ", digits " +
           std::to_string(c.refused[2]) + ", bits " + std::to_string(c.refused[3]) + ", counts too far " +
           std::to_string(c.far) + "; jumps " + std::to_string(c.jumps) + ", transfers failed " +
           std::to_string(c.transfers_failed) + ", stalls " + std::to_string(c.stalls) +
           ", connected again " + std::to_string(c.reconnects);
}

Pump::Pump(FtdiBus& bus, std::string serial, double rad_per_count)
    : bus_(bus),
      serial_(std::move(serial)),
      boot_(bus),
      counts_per_s_(kLegRadS / rad_per_count),
      amplifier_(0, kMost) {}

std::uint32_t Pump::us() noexcept {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_ns(bus_.now())) / 1000U);
}

BusFinding Pump::open() {
    BusFinding found = bus_.open(serial_);
    if (found.fault == BusFault::none) {
        if (serial_.empty()) serial_ = found.serial;  // from now on this one
        connected(bus_.now(), false);
    }
    return found;
}

void Pump::connected(Instant now, bool anew) noexcept {
    news_.link = Link::starting;
    news_.boot_fault = BootFault::none;
    news_.reply.homed = 0;
    news_.on = news_.tripped = false;
    sending_ = due_ = stalled_ = known_ = moved_ = false;
    owed_ = unanswered_ = far_ = 0;
    amplifier_ = phantom::Amplifier(0, kMost);  // off: enable has to be seen low first
    sequence_ = 0;
    boot_.start(now, anew);
    publish();
}

void Pump::reopen(Instant now) noexcept {
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
    connected(now, false);
}

void Pump::lose(Instant now) noexcept {
    bus_.close();
    news_.link = Link::closed;
    news_.reply.homed = 0;
    news_.on = news_.tripped = false;
    sending_ = moved_ = false;
    retry_at_ = now + kReopenEvery;
}

bool Pump::quiet() const noexcept { return news_.link != Link::open || (!moved_ && !sending_); }

Duration Pump::patience() const noexcept {
    constexpr Duration kLong = std::chrono::milliseconds(1);  // the watchdog is looked at that often
    if (news_.link != Link::open || owed_ > 0) return kLong;
    const Instant now = bus_.now();
    const Duration since = now - ordered_at_, interval(interval_ns_), idle = asked_at_ + kIdle - now;
    const bool still = since > 20 * interval;  // the servo
    return std::clamp(still ? idle : std::min(idle, interval - since), kPoll, kLong);
}

void Pump::follow_boot(Instant now) noexcept {
    boot_.round(now);
    news_.boot_fault = boot_.fault();
    if (boot_.state() == BootState::failed) {
        news_.link = Link::refused;
        retry_at_ = now + 10 * kReopenEvery;  // then all of it again
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
    const std::uint64_t written = mailbox_->order.count();
    if (written == orders_seen_ || !mailbox_->order.read(order)) return;
    orders_seen_ = written;
    const std::int64_t passed = order.written_at_ns - to_ns(ordered_at_);
    if (passed > 0) interval_ns_ = std::clamp<std::int64_t>(passed, 50'000, 2'000'000);
    ordered_at_ = std::min(instant_from_ns(order.written_at_ns), now);
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
    if (!bus_.send(encode(Request{torque, colour, true}))) return;
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
    // What comes now was asked for too long ago.
    if (!bus_.control(ftdi::kForgetIn) || ++unanswered_ >= kUnansweredMax) lose(now);
}

// Before they are homed counts mean nothing, and jump when they begin to.
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
    owed_ = 0;  // a bad reply is one too: asked again at once
    sent_answers_ns_ = last_answers_ns_ = 0;
}

void Pump::take(const BusEvent& event) noexcept {
    if (news_.link == Link::closed) return;
    switch (event.kind) {
        case BusEventKind::packet:
            return take_bytes(
                std::span(event.bytes).first(std::min<std::size_t>(event.size, event.bytes.size())),
                event.at);
        case BusEventKind::sent:
            sending_ = false;
            return;
        case BusEventKind::send_failed:
            sending_ = false;
            moved_ = true;  // what the motors have is not known: the next zero is said again
            ++news_.counts.transfers_failed;
            return;
        case BusEventKind::receive_failed:
            ++news_.counts.transfers_failed;
            return;
        case BusEventKind::stalled:
            ++news_.counts.stalls;
            sending_ = false;
            stalled_ = true;
            return;
        case BusEventKind::gone:
            return lose(event.at);
    }
}

void Pump::count_second(Instant now) noexcept {
    if (now - second_at_ < std::chrono::seconds(1)) return;
    second_at_ = now;
    const std::uint64_t bad = news_.counts.bad() - second_bad_, taken = news_.counts.taken - second_taken_;
    news_.last_second_bad = bad * 20 > bad + taken;
    second_bad_ = news_.counts.bad();
    second_taken_ = news_.counts.taken;
}

void Pump::publish() noexcept { mailbox_->news.publish(news_); }

void Pump::round(Duration patience) noexcept {
    const Instant now = bus_.now();
    if (news_.link == Link::closed) reopen(now);
    if (news_.link == Link::refused && now >= retry_at_) lose(now);
    if (news_.link == Link::starting) follow_boot(now);
    if (news_.link == Link::open) send_due(now);
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
    const Instant after = bus_.now();
    if (news_.link == Link::starting) follow_boot(after);
    if (news_.link == Link::open) look_at_replies(after);
    if (news_.link == Link::open) send_due(after);
    count_second(after);
    publish();
}

}  // namespace tact::falcon
