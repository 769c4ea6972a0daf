#include "gui/dashboard/trace_store.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "ipc/base/run_state.hpp"
#include "ipc/topics/text.hpp"

namespace tact {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeast = std::numeric_limits<float>::lowest(), kMost = std::numeric_limits<float>::max();
constexpr std::int64_t kYearsNs = 1'000'000'000'000'000'000;  // thirty years

constexpr std::array<TraceChannelInfo, kTraceChannels> kChannels{{
    {"force", "N", 1.0, "force_n"},
    {"force x", "N", 1.0, "force_x_n"},
    {"force y", "N", 1.0, "force_y_n"},
    {"force z", "N", 1.0, "force_z_n"},
    {"model error", "N", 1.0, "model_error_n"},
    {"torque", "mN m", 1e3, "torque_n_m"},
    {"position x", "mm", 1e3, "position_x_m"},
    {"position y", "mm", 1e3, "position_y_m"},
    {"position z", "mm", 1e3, "position_z_m"},
    {"lateness", "µs", 1e6, "lateness_s"},
    {"cycle", "µs", 1e6, "cost_s"},
    {"model", "µs", 1e6, "model_s"},
    {"level", "0-1", 1.0, "level"},
    {"items", "items", 1.0, "items"},
}};

float size_of(const float (&v)[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

void append(std::string& out, double value) {
    if (!std::isfinite(value)) return;  // an empty field
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value);
    out.append(text, end.ptr);
}

void append(std::string& out, std::uint64_t value) {
    char text[24];
    const auto end = std::to_chars(text, text + sizeof text, value);
    out.append(text, end.ptr);
}

}  // namespace

const TraceChannelInfo& trace_channel(TraceChannel channel) {
    return kChannels[std::min(static_cast<std::size_t>(channel), kTraceChannels - 1)];
}

float trace_value(const TraceTopic& c, TraceChannel channel) {
    float v = kNone;
    switch (channel) {
        case TraceChannel::force:
            v = size_of(c.force_world_n);
            break;
        case TraceChannel::force_x:
        case TraceChannel::force_y:
        case TraceChannel::force_z:
            v = c.force_world_n[static_cast<int>(channel) - static_cast<int>(TraceChannel::force_x)];
            break;
        case TraceChannel::error:
            v = c.model_error_n;
            break;
        case TraceChannel::torque:
            v = size_of(c.torque_world_n_m);
            break;
        case TraceChannel::position_x:
        case TraceChannel::position_y:
        case TraceChannel::position_z:
            v = c.pos_world_m[static_cast<int>(channel) - static_cast<int>(TraceChannel::position_x)];
            break;
        case TraceChannel::lateness:
            v = 1e-9F * static_cast<float>(c.lateness_ns);
            break;
        case TraceChannel::cost:
            v = 1e-9F * static_cast<float>(c.cost_ns);
            break;
        case TraceChannel::model:
            v = 1e-9F * static_cast<float>(c.model_ns);
            break;
        case TraceChannel::level:
            v = c.level;
            break;
        case TraceChannel::items:
            v = static_cast<float>(c.items);
            break;
        case TraceChannel::count:
            break;
    }
    return std::isfinite(v) ? v : kNone;
}

bool trace_overran(const TraceTopic& c, std::int64_t period_ns) {
    return period_ns > 0 && std::int64_t{c.lateness_ns} + c.cost_ns > period_ns;
}

bool trace_faulted(const TraceTopic& c) {
    return (c.status & 0xFFU) == static_cast<std::uint32_t>(RunState::fault);
}

TraceStore::TraceStore() : ring_(kSlots), blocks_(kSlots / kBlock) {}

void TraceStore::clear() { total_ = 0; }

bool TraceStore::add(const TraceTopic& cycle) {
    if (cycle.taken_at_ns <= 0 || cycle.taken_at_ns > kYearsNs ||
        (total_ > 0 && cycle.taken_at_ns <= end_ns())) {
        ++refused_;
        return false;
    }
    const std::size_t slot = total_ % kSlots;
    ring_[slot] = cycle;
    Block& block = blocks_[slot / kBlock];
    if (slot % kBlock == 0) {
        block.low.fill(kMost);
        block.high.fill(kLeast);
    }
    for (std::size_t i = 0; i < kTraceChannels; ++i) {
        const float v = trace_value(cycle, static_cast<TraceChannel>(i));
        if (std::isnan(v)) continue;
        block.low[i] = std::min(block.low[i], v);
        block.high[i] = std::max(block.high[i], v);
    }
    ++total_;
    return true;
}

void TraceStore::copy(const TraceStore& other, std::int64_t begin_ns, std::int64_t end_ns) {
    clear();
    for (std::size_t i = other.find(begin_ns); i < other.size() && other.at(i).taken_at_ns <= end_ns; ++i)
        static_cast<void>(add(other.at(i)));
}

std::size_t TraceStore::find(std::int64_t at_ns) const {
    std::size_t first = 0, last = size();
    while (first < last) {
        const std::size_t middle = (first + last) / 2;
        if (at(middle).taken_at_ns < at_ns) {
            first = middle + 1;
        } else {
            last = middle;
        }
    }
    return first;
}

TraceExtremes TraceStore::extremes(TraceChannel channel, std::size_t first, std::size_t last) const {
    TraceExtremes e{kMost, kLeast, false};
    last = std::min(last, size());
    const auto c = static_cast<std::size_t>(channel);
    const auto take = [&e](float low, float high) {
        if (!(low <= high)) return;  // empty block, or NaN
        e.low = std::min(e.low, low);
        e.high = std::max(e.high, high);
        e.any = true;
    };
    const std::size_t oldest = total_ - size();
    for (std::size_t i = first; i < last;) {
        const std::size_t slot = (oldest + i) % kSlots;
        if (slot % kBlock == 0 && i + kBlock <= last) {
            take(blocks_[slot / kBlock].low[c], blocks_[slot / kBlock].high[c]);
            i += kBlock;
        } else {
            const float v = trace_value(ring_[slot], channel);
            take(v, v);
            ++i;
        }
    }
    return e;
}

std::string trace_csv(std::span<const TraceTopic> cycles, std::span<const TraceChannel> channels) {
    std::string out = "time_s,taken_at_ns,cycle,state";
    for (const TraceChannel c : channels) out += std::string(",") + trace_channel(c).column;
    out += '\n';
    out.reserve(out.size() + cycles.size() * (48 + 14 * channels.size()));
    for (const TraceTopic& cycle : cycles) {
        append(out, 1e-9 * static_cast<double>(cycle.taken_at_ns - cycles.front().taken_at_ns));
        out += ',';
        append(out, static_cast<std::uint64_t>(cycle.taken_at_ns));
        out += ',';
        append(out, cycle.cycle);
        out += ',';
        out += run_state_text(static_cast<RunState>(cycle.status & 0xFFU));
        for (const TraceChannel c : channels) {
            out += ',';
            // Nine digits reproduce a float exactly.
            const auto v = static_cast<double>(trace_value(cycle, c));
            if (!std::isfinite(v)) continue;
            char text[40];
            const auto end = std::to_chars(text, text + sizeof text, v, std::chars_format::general, 9);
            out.append(text, end.ptr);
        }
        out += '\n';
    }
    return out;
}

}  // namespace tact
