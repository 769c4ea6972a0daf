// All servo cycles of the last minute, with the extremes of any range available without scanning it.
//
// Blocks   store the extremes of 64 cycles each, so a frame of a minute reads a thousand blocks, not all cycles
// Memory   allocated once; the oldest cycles are overwritten.  Thread  one; plain arithmetic
// Hostile  a record whose time does not rise, or is years off, is refused and counted; NaN values are ignored
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/topics/event.hpp"

namespace tact {

enum class TraceChannel : std::uint8_t {
    force,
    force_x,
    force_y,
    force_z,
    error,
    torque,
    position_x,
    position_y,
    position_z,
    lateness,
    cost,
    model,
    level,
    items,
    count
};
inline constexpr std::size_t kTraceChannels = static_cast<std::size_t>(TraceChannel::count);

struct TraceChannelInfo {
    const char* name;    // "force x"
    const char* unit;    // as displayed
    double scale;        // stored value -> shown value
    const char* column;  // in an exported table, SI: "force_x_n"
};
[[nodiscard]] const TraceChannelInfo& trace_channel(TraceChannel channel);
// SI, world frame; NaN if the record has none.
[[nodiscard]] float trace_value(const TraceTopic& cycle, TraceChannel channel);
// True if it ended after the next cycle was due; always false in a free-running loop (period_ns 0).
[[nodiscard]] bool trace_overran(const TraceTopic& cycle, std::int64_t period_ns);
[[nodiscard]] bool trace_faulted(const TraceTopic& cycle);

struct TraceExtremes {
    float low = 0.0F, high = 0.0F;
    bool any = false;
};

class TraceStore {
public:
    static constexpr std::size_t kSlots = std::size_t{1} << 16;
    static constexpr std::size_t kBlock = 64;
    static constexpr std::size_t kKept = kSlots - kBlock;  // the block being overwritten has no extremes

    TraceStore();
    bool add(const TraceTopic& cycle);
    void clear();
    // Replaces the contents by those of another store between these times.
    void copy(const TraceStore& other, std::int64_t begin_ns, std::int64_t end_ns);

    [[nodiscard]] std::size_t size() const { return total_ < kKept ? total_ : kKept; }
    [[nodiscard]] bool empty() const { return total_ == 0; }
    [[nodiscard]] const TraceTopic& at(std::size_t index) const {
        return ring_[(total_ - size() + index) % kSlots];
    }
    [[nodiscard]] std::int64_t begin_ns() const { return empty() ? 0 : at(0).taken_at_ns; }
    [[nodiscard]] std::int64_t end_ns() const { return empty() ? 0 : at(size() - 1).taken_at_ns; }
    // Index of the first cycle not before at_ns; size(): none.
    [[nodiscard]] std::size_t find(std::int64_t at_ns) const;
    // True if cycles are missing before it.
    [[nodiscard]] bool gap_before(std::size_t index) const {
        return index > 0 && at(index).cycle != at(index - 1).cycle + 1;
    }
    // Over [first, last).
    [[nodiscard]] TraceExtremes extremes(TraceChannel channel, std::size_t first, std::size_t last) const;

    [[nodiscard]] std::uint64_t refused() const { return refused_; }
    [[nodiscard]] std::size_t memory_bytes() const {
        return ring_.capacity() * sizeof(TraceTopic) + blocks_.capacity() * sizeof(Block);
    }

private:
    struct Block {
        std::array<float, kTraceChannels> low, high;
    };
    std::vector<TraceTopic> ring_;
    std::vector<Block> blocks_;
    std::size_t total_ = 0;
    std::uint64_t refused_ = 0;
};

// Cycles as CSV: time since the first one, timestamp, number, state, and a column for each channel.
[[nodiscard]] std::string trace_csv(std::span<const TraceTopic> cycles,
                                    std::span<const TraceChannel> channels);

}  // namespace tact
