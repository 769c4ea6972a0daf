// The dialog before an import: what the files are, and what a person answers. Read from `tact-prep examine`.
//
// Structures their names are edited in a table beside the files, which the import reads
// Answers    arguments(): a number that was left as proposed is no argument, so the scene says where it comes from
// Untrusted  sizes and numbers of the report are bounded; what does not fit is left out
// Thread     any; plain data. Drawn by import_form_panel.hpp
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/scene/bone/structure_table.hpp"

namespace tact {

struct ImportForm {
    static constexpr std::size_t kLinesMost = 16, kNumbersMost = 4, kChoicesMost = 3, kRowsMost = 64,
                                 kBinsMost = 1024, kTextMost = 200, kStructuresMost = 255;
    struct Line {
        std::string label, value;
    };
    struct Number {
        std::string option, label, unit, help, proposed;  // proposed: as typed; empty: none
        double low = 0.0, high = 0.0;                     // of an answer
        bool in_histogram = false;
        bool of_file = false;  // an answer for this file alone
        std::array<char, 24> typed{};
        std::string recalled,
            recalled_from;  // answer of an earlier import, as typed, and which: "As for head.nrrd."
        // The answer, if it is a number within the limits.
        [[nodiscard]] std::optional<double> value() const;
        void set(double value);
    };
    struct Choice {
        std::string option, label;
        std::vector<std::pair<std::string, std::string>> rows;  // value, text
        std::size_t chosen = 0;
        std::string recalled_from{};  // as of numbers
    };
    struct Structure {
        StructureRow row;  // as the report says
        std::array<char, 64> name{};
        bool critical = false;
    };
    std::vector<Line> lines;
    double low = 0.0, high = 0.0;  // of the histogram
    std::vector<float> bins;       // logarithm of the counts, 0 to 1; empty: no histogram
    std::vector<Number> numbers;
    std::vector<Choice> choices;
    std::vector<Structure> structures;
    std::string structure_table;  // where their names are kept; empty: nowhere
    std::vector<std::string> warnings;

    std::string title;                         // "Drill head.nrrd."
    bool shown = false;                        // once
    bool takes_keys = false;                   // what is typed reaches the first answer that is missing
    bool answered = false, cancelled = false;  // by the person
    bool other_choice = false;                 // the files must be examined again, with choice_arguments()

    [[nodiscard]] bool complete() const;
    // The table with the names as typed; empty if none was changed.
    [[nodiscard]] std::string edited_table() const;
    [[nodiscard]] std::vector<std::string> arguments() const;  // of all answers
    [[nodiscard]] std::vector<std::string> choice_arguments() const;
};

// Empty where the text is no report.
[[nodiscard]] std::optional<ImportForm> read_import_form(std::string_view json);

}  // namespace tact
