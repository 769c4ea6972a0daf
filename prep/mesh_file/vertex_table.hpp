// Assigns one number to equal positions: a hash table of 4 bytes per slot over positions stored elsewhere.
//
// -0 equals 0; positions are finite. Numbers are assigned in the order of the calls, independent of the table.
// Memory: 8 to 16 bytes per vertex.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "ipc/base/huge_pages.hpp"

namespace tact {

class VertexTable {
public:
    explicit VertexTable(std::size_t expected) {
        place_.assign(std::bit_ceil(std::max<std::size_t>(expected * 2, 64)), kNone);
    }
    // The number of the vertex at p in position_m (3 floats each), or kNone if it has none. The caller then appends p
    // to position_m before the next call.
    std::uint32_t find(const std::array<float, 3>& p, const std::vector<float>& position_m) {
        if (2 * (used_ + 1) > place_.size()) grow(position_m);
        std::size_t at = slot(p);
        for (; place_[at] != kNone; at = (at + 1) & (place_.size() - 1)) {
            const float* q = &position_m[3 * std::size_t{place_[at]}];
            if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) return place_[at];
        }
        place_[at] = static_cast<std::uint32_t>(position_m.size() / 3);
        ++used_;
        return kNone;
    }
    static constexpr std::uint32_t kNone = UINT32_MAX;

private:
    [[nodiscard]] std::size_t slot(const std::array<float, 3>& p) const {
        std::uint64_t h = 0x9E3779B97F4A7C15;
        for (const float x : p) {
            h = (h ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0xD6E8FEB86659FD93;
            h ^= h >> 32U;
        }
        return static_cast<std::size_t>(h) & (place_.size() - 1);
    }
    void grow(const std::vector<float>& position_m) {
        const HugeVector<std::uint32_t> old = std::move(place_);
        place_.assign(2 * old.size(), kNone);
        for (const std::uint32_t v : old) {
            if (v == kNone) continue;
            const float* q = &position_m[3 * std::size_t{v}];
            std::size_t at = slot({q[0], q[1], q[2]});
            while (place_[at] != kNone) at = (at + 1) & (place_.size() - 1);
            place_[at] = v;
        }
    }
    HugeVector<std::uint32_t> place_;
    std::size_t used_ = 0;
};

}  // namespace tact
