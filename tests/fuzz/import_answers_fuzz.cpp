// Answers of earlier imports with arbitrary bytes: refused with a message, or bounded and safe to propose in a dialog.
#include <cstring>

#include "gui/window/import_answers.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    std::vector<ImportAnswers> imports;
    try {
        imports = read_answers_text(text, "file");
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
        return false;
    }
    require(imports.size() <= kImportsMost);
    for (const ImportAnswers& each : imports) {
        require(each.file.path.front() == '/' && each.answers.size() <= kAnswersMost);
        for (const auto& [option, value] : each.answers) {
            require(option.starts_with("--") && !value.empty());
            for (const char c : option + value) require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
        }
        auto form = read_import_form(
            R"({"lines":[],"numbers":[{"option":"--a","low":0,"high":5},{"option":"--b","low":-1,"high":1,"proposed":0.5}],)"
            R"("choices":[{"option":"--c","chosen":0,"rows":[{"value":"x","text":""},{"value":"y","text":""}]}]})");
        const auto found = recall(imports, each.file);
        require(found.has_value());
        static_cast<void>(propose(*found, true, *form));
        for (const ImportForm::Number& n : form->numbers) require(n.value() || n.typed[0] == 0);
        require(form->choices[0].chosen < 2);
    }
    require(read_answers_text(answers_text(imports), "written") == imports);
    const auto more = with_answers(imports, {{"/new.nrrd", 1, 2, "drill"}, {{"--a", "3"}}});
    require(more.size() <= kImportsMost && more.front().file.path == "/new.nrrd");
    return true;
}

std::vector<Input> seeds() {
    const std::string text =
        answers_text({{{"/data/a.nrrd", 12, 1793000000, "drill"}, {{"--a", "3.5"}, {"--c", "y"}}},
                      {{"/data/\"\\", 0, -1, "dock"}, {{"--a", "1e400"}, {"--b", "0.25"}}},
                      {{"/data", 0, 0, "touch"}, {}}});
    return {{std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end()}};
}

}  // namespace tact::fuzz
