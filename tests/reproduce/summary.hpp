// The summary of a reproduction: one row per published number, with the measured one beside it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

struct SummaryRow {
    std::string figure{};     // of the paper: "5"
    std::string quantity{};   // with its unit
    std::string published{};  // as printed in the paper
    std::string measured{};   // on this machine
    std::string differs{};    // difference and its reason; empty: none
};

// Formats the rows as a table; columns are as wide as needed, the last one wraps.
[[nodiscard]] std::string table_of(const std::vector<SummaryRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<SummaryRow>& rows);

}  // namespace tact::launch
