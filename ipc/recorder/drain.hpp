// Reads the servo's rings step by step, and counts lost records.
//
// Whole     a step comes with its cycle and all of its hands, or not at all
// Lost      by lapping, counted per ring; steps without a hand count as lost cycles
// Input     untrusted: rings hold any numbers; the output is bounded by the capacity of the rings
// Thread    one; never blocks
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/record/rows.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::record {

// Records of a period of time.
struct Batch {
    std::vector<CycleTopic> cycles;
    std::array<std::vector<HandTopic>, kHandsMax> hand;  // as many as cycles
    std::vector<MailboxTopic> mailbox;
    std::vector<ReportTopic> reports;
    std::vector<EventTopic> events;
    std::vector<LevelsTopic> levels;
    std::vector<HealthTopic> health;
    std::vector<BodiesTopic> bodies;
    std::vector<DropRow> drops;

    [[nodiscard]] std::size_t bytes() const;
    void clear();
};

class Drain {
public:
    // Starts with the oldest records in the rings: earlier losses are not counted.
    explicit Drain(const RtRegion& region);

    void take(Batch& batch, std::int64_t now_ns);
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

private:
    void take_steps(Batch& batch);
    [[nodiscard]] bool hands_of(std::uint64_t step);
    void take_states(Batch& batch, std::int64_t now_ns);
    void count_drops(Batch& batch, std::int64_t now_ns);

    const RtRegion& region_;
    std::uint32_t hands_;
    static constexpr std::size_t kRings = 6;  // in the order of RecordRing
    std::array<RingCursor, kRings> at_{};
    std::array<std::uint64_t, kRings> missed_{};
    std::array<HandTopic, kHandsMax> next_hand_{};
    std::array<bool, kHandsMax> has_hand_{};
    std::uint64_t torn_steps_ = 0, torn_said_ = 0;
    std::uint64_t levels_seen_ = 0, health_seen_ = 0, bodies_seen_ = 0;
    std::int64_t bodies_at_ns_ = 0;
    std::uint64_t dropped_ = 0;
};

}  // namespace tact::record
