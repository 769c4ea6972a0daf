// The summary of a reproduction: one row per published value, with the measured value.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

struct SummaryRow {
    std::string figure{};     // number in the paper: "5"
    std::string quantity{};   // including its unit
    std::string published{};  // as printed in the paper
    std::string measured{};   // measured on this machine
    std::string differs{};    // reason for a difference; empty: none
};

// Formats the rows as a table. The column widths fit the contents; the reason is wrapped below its row.
[[nodiscard]] std::string table_of(const std::vector<SummaryRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<SummaryRow>& rows);

}  // namespace tact::launch
