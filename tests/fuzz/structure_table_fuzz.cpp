// A table of structures of arbitrary bytes: refused with a message, or rows that are written and read again unchanged.
#include "ipc/base/error.hpp"
#include "prep/drilling/structure_names.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    std::vector<ScanLabel> rows;
    try {
        rows = parse_structure_table(text, "table");
    } catch (const StartupError&) {
        return false;
    }
    for (ScanLabel& row : rows) {
        require(!row.name.empty() && (row.value != 0 || row.rgba[3] == 255));
        row.critical = row.critical.value_or(false);
        // Control characters are not written; a name of nothing else has none left.
        std::erase_if(row.name, [](unsigned char c) { return c < 32 || c == 127; });
        if (row.name.empty()) row.name = "x";
    }
    const auto again = parse_structure_table(structure_table_text(rows, {}), "written");
    require(again.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        require(again[i].name == rows[i].name && again[i].value == rows[i].value &&
                again[i].critical == rows[i].critical);
        if (rows[i].rgba[3] != 0) require(again[i].rgba == rows[i].rgba);
    }
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (const std::string& text :
         {std::string("[[structure]]\nlabel = 7\nname = \"a \\\"b\\\" \\\\ é\"\ncritical = true\n"),
          std::string("[[structure]]\ncolour = '#0aFf10'\nname = 'a'\n[[structure]]\ncolour = [1, 2, "
                      "3]\nlabel = 9\nname = 'b'\n")})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
