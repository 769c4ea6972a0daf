#include "ipc/recorder/drain.hpp"

#include <algorithm>

namespace tact::record {
namespace {

constexpr std::int64_t kBodiesEveryNs = 20'000'000;

template <class T>
std::size_t bytes_in(const std::vector<T>& v) {
    return v.size() * sizeof(T);
}

constexpr std::size_t index(RecordRing ring) { return static_cast<std::size_t>(ring); }

}  // namespace

std::size_t Batch::bytes() const {
    return bytes_in(cycles) + bytes_in(hand[0]) + bytes_in(hand[1]) + bytes_in(mailbox) + bytes_in(reports) +
           bytes_in(events) + bytes_in(levels) + bytes_in(health) + bytes_in(bodies) + bytes_in(drops);
}

void Batch::clear() {
    cycles.clear();
    for (auto& h : hand) h.clear();
    mailbox.clear();
    reports.clear();
    events.clear();
    levels.clear();
    health.clear();
    bodies.clear();
    drops.clear();
}

Drain::Drain(const RtRegion& region) : region_(region) {
    StartTopic start{};
    static_cast<void>(region.start.read(start));
    hands_ = std::clamp<std::uint32_t>(start.hands, 1, kHandsMax);
    const auto oldest = [](const auto& ring) {
        const std::uint64_t n = ring.pushed(), half = ring.kCapacity / 2;
        return RingCursor{n >= ring.kCapacity - 1 ? n - half : 1, 0};
    };
    at_ = {oldest(region.cycles),  oldest(region.hand[0]), oldest(region.hand[1]),
           oldest(region.mailbox), oldest(region.reports), oldest(region.events)};
}

void Drain::take(Batch& batch, std::int64_t now_ns) {
    take_steps(batch);
    // After the steps, so that the inputs of a step arrive with it.
    const auto take_all = [](const auto& ring, RingCursor& at, auto& to) {
        typename std::decay_t<decltype(to)>::value_type value{};
        for (std::uint64_t i = 0; i < ring.kCapacity && ring.next(at, value); ++i) to.push_back(value);
    };
    take_all(region_.mailbox, at_[index(RecordRing::mailbox)], batch.mailbox);
    take_all(region_.reports, at_[index(RecordRing::reports)], batch.reports);
    take_all(region_.events, at_[index(RecordRing::events)], batch.events);
    take_states(batch, now_ns);
    count_drops(batch, now_ns);
}

void Drain::take_steps(Batch& batch) {
    CycleTopic cycle{};
    RingCursor& at = at_[index(RecordRing::cycles)];
    for (std::uint64_t i = 0; i < region_.cycles.kCapacity && region_.cycles.next(at, cycle); ++i) {
        if (!hands_of(cycle.step)) {
            ++torn_steps_;
            continue;
        }
        batch.cycles.push_back(cycle);
        for (std::uint32_t h = 0; h < hands_; ++h) {
            batch.hand[h].push_back(next_hand_[h]);
            has_hand_[h] = false;
        }
    }
}

// The servo pushes a step's hands before its cycle, so they are present unless the ring lapped.
bool Drain::hands_of(std::uint64_t step) {
    bool all = true;
    for (std::uint32_t h = 0; h < hands_; ++h) {
        RingCursor& at = at_[index(RecordRing::hand0) + h];
        for (std::uint64_t i = 0; i < region_.hand[h].kCapacity; ++i) {
            if (has_hand_[h] && next_hand_[h].step >= step) break;
            has_hand_[h] = region_.hand[h].next(at, next_hand_[h]);
            if (!has_hand_[h]) break;
        }
        all = all && has_hand_[h] && next_hand_[h].step == step;
    }
    return all;
}

void Drain::take_states(Batch& batch, std::int64_t now_ns) {
    const auto newest = [](const auto& latest, std::uint64_t& seen, auto& to) {
        const std::uint64_t count = latest.count();
        typename std::decay_t<decltype(to)>::value_type value{};
        if (count == seen || !latest.read(value)) return;
        seen = count;
        to.push_back(value);
    };
    newest(region_.levels, levels_seen_, batch.levels);
    newest(region_.health, health_seen_, batch.health);
    if (now_ns - bodies_at_ns_ < kBodiesEveryNs) return;
    bodies_at_ns_ = now_ns;
    newest(region_.bodies, bodies_seen_, batch.bodies);
}

void Drain::count_drops(Batch& batch, std::int64_t now_ns) {
    const auto say = [&](RecordRing ring, std::uint64_t records) {
        if (records == 0) return;
        dropped_ += records;
        batch.drops.push_back({.noticed_at_ns = now_ns,
                               .ring = static_cast<std::uint32_t>(ring),
                               .reserved = 0,
                               .records = records});
    };
    for (std::size_t i = 0; i < kRings; ++i) {
        // A step without a hand is reported as a lost cycle, not in addition as a lost hand.
        const bool hand = i == index(RecordRing::hand0) || i == index(RecordRing::hand1);
        if (!hand) say(static_cast<RecordRing>(i), at_[i].missed - missed_[i]);
        missed_[i] = at_[i].missed;
    }
    say(RecordRing::cycles, torn_steps_ - torn_said_);
    torn_said_ = torn_steps_;
}

}  // namespace tact::record
