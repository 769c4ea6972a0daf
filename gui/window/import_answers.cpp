#include "gui/window/import_answers.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::size_t kAnswerPathMost = 4096, kAnswerMost = ImportForm::kTextMost;
constexpr const char* kAnswersFix =
    "fix or remove it; with the next import it is renamed and a new one written";

bool plain(const std::string& text, std::size_t most) {
    return !text.empty() && text.size() <= most && std::none_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
}

bool is_answer_option(const std::string& text) {
    return plain(text, 64) && text.starts_with("--") && text.size() > 2;
}

std::string ending_of(const std::string& path) {
    std::string name = std::filesystem::path(path).filename().string();
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return std::filesystem::path(name).extension().string();
}

}  // namespace

ImportedFile imported_file(const std::filesystem::path& path, const std::string& command) {
    ImportedFile file{std::filesystem::absolute(path).lexically_normal().string(), 0, 0, command};
    struct stat info {};
    if (::stat(file.path.c_str(), &info) != 0) return file;
    file.bytes = S_ISREG(info.st_mode) ? static_cast<std::uint64_t>(info.st_size) : 0;
    file.modified_ns = std::int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec;
    return file;
}

std::vector<ImportAnswers> read_answers_text(std::string_view text, const std::string& name) {
    const auto fail = [&](const std::string& why) {
        throw StartupError("reading the answers of earlier imports, " + name, why, kAnswersFix);
    };
    if (text.size() > kAnswersBytesMost) fail("the file is too large");
    const nlohmann::json all = nlohmann::json::parse(text, nullptr, false);
    if (!all.is_object() || !all.contains("imports") || !all["imports"].is_array())
        fail("it is not JSON with a list 'imports'");
    std::vector<ImportAnswers> imports;
    for (const auto& each : all["imports"]) {
        if (imports.size() == kImportsMost) break;
        const auto has = [&](const char* key, bool (nlohmann::json::*is)() const noexcept) {
            return each.is_object() && each.contains(key) && (each[key].*is)();
        };
        if (!has("path", &nlohmann::json::is_string) || !has("bytes", &nlohmann::json::is_number_unsigned) ||
            !has("modified_ns", &nlohmann::json::is_number_integer) ||
            !has("command", &nlohmann::json::is_string) || !has("answers", &nlohmann::json::is_object))
            fail("an import in it lacks path, bytes, modified_ns, command or answers");
        ImportAnswers one{{each["path"].get<std::string>(), each["bytes"].get<std::uint64_t>(),
                           each["modified_ns"].get<std::int64_t>(), each["command"].get<std::string>()},
                          {}};
        if (!plain(one.file.path, kAnswerPathMost) || one.file.path.front() != '/' ||
            !plain(one.file.command, 32))
            fail("a path in it is not absolute, too long, or holds a control character");
        for (const auto& [option, value] : each["answers"].items()) {
            if (one.answers.size() == kAnswersMost || !is_answer_option(option) || !value.is_string() ||
                !plain(value.get<std::string>(), kAnswerMost))
                fail("an answer in it is no option with a short text, or there are too many");
            one.answers.emplace(option, value.get<std::string>());
        }
        imports.push_back(std::move(one));
    }
    return imports;
}

std::string answers_text(const std::vector<ImportAnswers>& imports) {
    nlohmann::json list = nlohmann::json::array();
    for (const ImportAnswers& each : imports)
        list.push_back({{"path", each.file.path},
                        {"bytes", each.file.bytes},
                        {"modified_ns", each.file.modified_ns},
                        {"command", each.file.command},
                        {"answers", each.answers}});
    try {
        return nlohmann::json{{"imports", std::move(list)}}.dump(1) + "\n";
    } catch (const nlohmann::json::exception&) {
        throw StartupError("keeping the answers of an import", "a path is not UTF-8",
                           "give the file a name in UTF-8");
    }
}

std::vector<ImportAnswers> read_answers(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) return {};
    std::ifstream in;
    if (std::filesystem::is_regular_file(status)) in.open(file, std::ios::binary);
    if (!in.is_open())
        throw StartupError("reading the answers of earlier imports, " + file.string(),
                           "it is not a file that can be read", kAnswersFix);
    std::string text(kAnswersBytesMost + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return read_answers_text(text, file.string());
}

std::vector<ImportAnswers> with_answers(std::vector<ImportAnswers> imports, ImportAnswers newest) {
    std::erase_if(imports, [&](const ImportAnswers& each) {
        return each.file.path == newest.file.path && each.file.command == newest.file.command;
    });
    imports.insert(imports.begin(), std::move(newest));
    // Both bounds of the file hold, also for long paths.
    if (imports.size() > kImportsMost) imports.resize(kImportsMost);
    while (imports.size() > 1 && answers_text(imports).size() > kAnswersBytesMost) imports.pop_back();
    return imports;
}

std::optional<Recalled> recall(const std::vector<ImportAnswers>& imports, const ImportedFile& file) {
    const auto name = [](const ImportAnswers& each) {
        return std::filesystem::path(each.file.path).filename().string();
    };
    for (const ImportAnswers& each : imports)
        if (each.file == file && file.modified_ns != 0) return Recalled{each.answers, true, name(each)};
    const auto folder = [](const std::string& path) { return std::filesystem::path(path).parent_path(); };
    for (const ImportAnswers& each : imports)
        if (each.file.command == file.command && folder(each.file.path) == folder(file.path) &&
            ending_of(each.file.path) == ending_of(file.path))
            return Recalled{each.answers, false, name(each)};
    return std::nullopt;
}

bool propose(const Recalled& recalled, bool choices, ImportForm& form) {
    const std::string as =
        recalled.same_file ? "As answered for this file before." : "As for " + recalled.name + ".";
    for (ImportForm::Number& number : form.numbers) {
        const auto found = recalled.answers.find(number.option);
        if (found == recalled.answers.end() || (number.of_file && !recalled.same_file) ||
            found->second.size() >= number.typed.size())
            continue;
        ImportForm::Number answered = number;
        std::snprintf(answered.typed.data(), answered.typed.size(), "%s", found->second.c_str());
        if (!answered.value() || answered.proposed == answered.typed.data()) continue;
        answered.recalled = found->second;
        answered.recalled_from = as;
        number = std::move(answered);
    }
    bool other = false;
    for (ImportForm::Choice& choice : form.choices) {
        const auto found = recalled.answers.find(choice.option);
        if (found == recalled.answers.end()) continue;
        if (!choices) {  // the files were examined with it
            if (choice.rows[choice.chosen].first == found->second) choice.recalled_from = as;
            continue;
        }
        const auto row = std::find_if(choice.rows.begin(), choice.rows.end(),
                                      [&](const auto& each) { return each.first == found->second; });
        const auto at = static_cast<std::size_t>(row - choice.rows.begin());
        if (row == choice.rows.end()) continue;
        choice.recalled_from = as;
        other = other || at != choice.chosen;
        choice.chosen = at;
    }
    return other;
}

std::map<std::string, std::string> answers_of(const ImportForm& form) {
    std::map<std::string, std::string> answers;
    for (const ImportForm::Number& number : form.numbers)
        if (number.value() && number.proposed != number.typed.data() && answers.size() < kAnswersMost)
            answers.emplace(number.option, number.typed.data());
    for (const ImportForm::Choice& choice : form.choices)
        if (choice.chosen < choice.rows.size() && plain(choice.rows[choice.chosen].first, kAnswerMost) &&
            answers.size() < kAnswersMost)
            answers.emplace(choice.option, choice.rows[choice.chosen].first);
    return answers;
}

}  // namespace tact
