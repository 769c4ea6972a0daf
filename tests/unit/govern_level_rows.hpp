// Candidate rows for the tests of LevelFit.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "rt/govern/level_fit.hpp"

namespace tact::test {

using Rows = std::vector<LevelFit::Row>;

inline constexpr double kUs = 1e-6;

// Costs double from level to level, errors halve; the last is exact.
inline Rows doubling(std::size_t count, double first_us) {
    Rows rows;
    for (std::size_t i = 0; i < count; ++i)
        rows.push_back({.level = static_cast<float>(i) / static_cast<float>(count - 1),
                        .cost_s = kUs * first_us * std::exp2(static_cast<double>(i)),
                        .error = i + 1 == count ? 0.0 : std::exp2(-static_cast<double>(i))});
    return rows;
}

inline LevelFit with(const Rows& rows) {
    LevelFit fit;
    EXPECT_TRUE(fit.set_rows(rows));
    return fit;
}

}  // namespace tact::test
