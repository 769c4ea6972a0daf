// Maximum of any range of an array: a sparse table over blocks, and a scan of at most two blocks.
//
// The array must outlive this object and stay constant.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ipc/base/huge_pages.hpp"

namespace tact {

class RangeMax {
public:
    explicit RangeMax(const HugeVector<std::uint32_t>& value) : value_(value) {
        table_.emplace_back((value.size() + kBlock - 1) / kBlock, 0);
        for (std::size_t i = 0; i < value.size(); ++i)
            table_[0][i / kBlock] = std::max(table_[0][i / kBlock], value[i]);
        for (std::size_t step = 1; 2 * step <= table_[0].size(); step *= 2) {
            const std::vector<std::uint32_t>& low = table_.back();
            std::vector<std::uint32_t> high(low.size() - step);
            for (std::size_t i = 0; i < high.size(); ++i) high[i] = std::max(low[i], low[i + step]);
            table_.push_back(std::move(high));
        }
    }
    [[nodiscard]] std::uint32_t of(std::size_t first, std::size_t end) const {  // first < end
        const std::size_t low = first / kBlock + 1, high = end / kBlock;
        if (low >= high) return plain(first, end);
        std::uint32_t most = std::max(plain(first, low * kBlock), plain(high * kBlock, end));
        std::size_t level = 0;
        while (std::size_t{2} << level <= high - low) ++level;
        most = std::max({most, table_[level][low], table_[level][high - (std::size_t{1} << level)]});
        return most;
    }

private:
    static constexpr std::size_t kBlock = 64;
    [[nodiscard]] std::uint32_t plain(std::size_t first, std::size_t end) const {
        std::uint32_t most = 0;
        for (; first < end; ++first) most = std::max(most, value_[first]);
        return most;
    }
    const HugeVector<std::uint32_t>& value_;
    std::vector<std::vector<std::uint32_t>> table_;
};

}  // namespace tact
