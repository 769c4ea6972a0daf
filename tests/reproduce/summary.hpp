// What a reproduction says in the end: one row per number of the seed, with ours beside it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

struct SummaryRow {
    std::string figure{};    // of the seed: "5"
    std::string quantity{};  // with its unit
    std::string seed{};      // as printed there
    std::string ours{};
    std::string differs{};  // what is different and why; empty: it is not
};

// As a table for people; columns are as wide as they need, the last one wraps.
[[nodiscard]] std::string table_of(const std::vector<SummaryRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<SummaryRow>& rows);

}  // namespace tact::launch
