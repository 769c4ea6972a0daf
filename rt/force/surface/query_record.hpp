// Queries that recent steps of the 6-DoF tool needed, and how often a level with fewer would have lagged.
//
// Share    of the recent steps in contact that needed more than q queries, of triangles or of distances. A step that ran
//          out of them counts as one that needed more, which kQueriesMost would have been enough for, unless it had those
// Prior    kPrior steps: 7 in a hundred need any to speak of, and a share falls by e every 75 queries. Measured with the
//          emulated hand's strokes at 2 kHz (TOOLS.md). So levels differ before the first contact
// Thread   servo; no allocation
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ipc/base/rt.hpp"
#include "rt/force/surface/tool_contact.hpp"

namespace tact {

class QueryRecord {
public:
    static constexpr double kPrior = 2000.0, kMemory = 8000.0;  // steps
    static constexpr double kPriorShare = 0.07, kPriorQueries = 75.0, kPriorPull_n = 0.7;

    QueryRecord() noexcept {
        for (std::size_t i = 0; i < kBins; ++i) {
            const auto above = [](std::size_t widths) {
                return kPriorShare * std::exp(-static_cast<double>(kWidth * widths) / kPriorQueries);
            };
            steps_[i] = kPrior * ((i == 0 ? 1.0 : above(i - 1)) - (i + 1 < kBins ? above(i) : 0.0));
        }
        total_ = kPrior;
    }

    // A step in contact that was not cut by its deadline; limit: of its queries.
    void add(const ToolTouch& touch, std::uint32_t limit, double pulled_n) noexcept TACT_RT {
        std::uint32_t needed = std::max(touch.looked, touch.asked);
        if (touch.state == ContactState::lagging && needed >= limit)
            needed =
                limit < ToolContact::kQueriesMost ? ToolContact::kQueriesMost : ToolContact::kQueriesMost + 1;
        else
            needed = std::min(needed, ToolContact::kQueriesMost);
        steps_[bin(needed)] += 1.0;
        total_ += 1.0;
        if (total_ >= kMemory) {
            for (double& n : steps_) n *= 0.5;
            total_ *= 0.5;
        }
        pull_n_ += (pulled_n - pull_n_) * kPullStep;
    }
    // Share of the steps that would have lagged with this limit.
    [[nodiscard]] double lagged(std::uint32_t limit) const noexcept TACT_RT {
        double above = 0.0;
        for (std::size_t i = bin(limit) + 1; i < kBins; ++i) above += steps_[i];
        return above / total_;
    }
    // Mean force of the steps.
    [[nodiscard]] double pull_n() const noexcept TACT_RT { return pull_n_; }

private:
    static constexpr std::uint32_t kWidth = 8;  // queries
    static constexpr std::size_t kBins =
        ToolContact::kQueriesMost / kWidth + 2;  // the last: more than the most
    static constexpr double kPullStep = 1e-3;

    // Bin i holds the steps that needed more than (i - 1) widths and at most i.
    static std::size_t bin(std::uint32_t needed) noexcept TACT_RT {
        return std::min<std::size_t>((needed + kWidth - 1) / kWidth, kBins - 1);
    }

    std::array<double, kBins> steps_{};
    double total_ = 0.0, pull_n_ = kPriorPull_n;
};

}  // namespace tact
