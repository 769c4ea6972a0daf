#include "prep/console/import_report.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace tact {

nlohmann::ordered_json import_report_json(const ImportReport& report) {
    nlohmann::ordered_json j = {{"lines", nlohmann::ordered_json::array()},
                                {"histogram", nullptr},
                                {"numbers", nlohmann::ordered_json::array()},
                                {"choices", nlohmann::ordered_json::array()},
                                {"warnings", report.warnings}};
    for (const auto& line : report.lines)
        j["lines"].push_back({{"label", line.label}, {"value", line.value}});
    if (report.histogram)
        j["histogram"] = {{"low", report.histogram->low},
                          {"high", report.histogram->high},
                          {"count", report.histogram->count}};
    for (const auto& n : report.numbers)
        j["numbers"].push_back(
            {{"option", n.option},
             {"label", n.label},
             {"unit", n.unit},
             {"help", n.help},
             {"low", n.low},
             {"high", n.high},
             {"proposed", n.proposed ? nlohmann::ordered_json(*n.proposed) : nlohmann::ordered_json(nullptr)},
             {"in_histogram", n.in_histogram},
             {"of_file", n.of_file}});
    for (const auto& c : report.choices) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const auto& row : c.rows) rows.push_back({{"value", row.value}, {"text", row.text}});
        j["choices"].push_back(
            {{"option", c.option}, {"label", c.label}, {"chosen", c.chosen}, {"rows", rows}});
    }
    j["structures"] = nlohmann::ordered_json::array();
    for (const auto& s : report.structures)
        j["structures"].push_back({{"label", s.label},
                                   {"colour", s.colour},
                                   {"name", s.name},
                                   {"critical", s.critical},
                                   {"voxels", s.voxels}});
    j["structure_table"] = report.structure_table;
    return j;
}

void print_import_report(const ImportReport& report) {
    std::printf("%s\n", import_report_json(report)
                            .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                            .c_str());
}

}  // namespace tact
