// What the files of an import are, and what their import asks: printed as JSON by `--examine`, for a dialog.
//
// JSON      lines [{label, value}], histogram {low, high, count[]}, numbers [{option, label, unit, help, low, high,
//           proposed, in_histogram, of_file}], choices [{option, label, chosen, rows [{value, text}]}], warnings [text],
//           structures [{label, colour, name, critical, voxels}], structure_table
// Answers   a number or the value of a row, as the value of its option of the same command
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tact {

struct ImportReport {
    struct Line {
        std::string label, value;
    };
    struct Histogram {
        double low = 0.0, high = 0.0;
        std::vector<double> count;
    };
    struct Number {
        std::string option, label, unit, help;
        double low = 0.0, high = 0.0;    // of an answer
        std::optional<double> proposed;  // none: a person must answer
        bool in_histogram = false;       // a value of the files
        bool of_file = false;            // says nothing about the next file of the same kind
    };
    struct Choice {
        struct Row {
            std::string value, text;
        };
        std::string option, label;
        std::vector<Row> rows;
        std::size_t chosen = 0;
    };
    // Named by a table beside the files (ipc/scene/bone/structure_table.hpp), which a person may edit before the import.
    struct Structure {
        unsigned label = 0;  // 0: known by its colour
        std::string colour;  // "#RRGGBB"
        std::string name;
        bool critical = false;
        std::uint64_t voxels = 0;
    };
    std::vector<Line> lines;
    std::optional<Histogram> histogram;
    std::vector<Number> numbers;
    std::vector<Choice> choices;  // another answer gives another report
    std::vector<Structure> structures;
    std::string structure_table;  // where the table lies, or would lie
    std::vector<std::string> warnings;
};

[[nodiscard]] nlohmann::ordered_json import_report_json(const ImportReport& report);
void print_import_report(const ImportReport& report);

}  // namespace tact
