// What a person answered in the dialogs of earlier imports, newest first, in a small JSON file of this user: proposed again for the same
// file, and for the next of the same type in its folder what is not of one file alone.
//
// File     {"imports": [{"path": "/data/head.nrrd", "bytes": 4711, "modified_ns": 1793000000000000000, "command": "drill",
//          "answers": {"--spacing-mm": "0.15"}}]}; at most kImportsMost, written completely or not at all
// Untrusted  bounded; a value is used only where the dialog of the file has such a question and its limits allow it
// Fails by StartupError; an unreadable file is reported.  Thread any; it waits for the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gui/window/import_form.hpp"

namespace tact {

struct ImportedFile {
    std::string path;              // absolute
    std::uint64_t bytes = 0;       // 0 of a folder
    std::int64_t modified_ns = 0;  // of the file's own clock
    std::string command;           // of tact: "dock"
    bool operator==(const ImportedFile&) const = default;
};

struct ImportAnswers {
    ImportedFile file;
    std::map<std::string, std::string> answers;  // by option, as typed
    bool operator==(const ImportAnswers&) const = default;
};

inline constexpr std::size_t kImportsMost = 64, kAnswersMost = 8, kAnswersBytesMost = std::size_t{256} * 1024;

// As it is on the disk now; one that is gone has no size.
[[nodiscard]] ImportedFile imported_file(const std::filesystem::path& path, const std::string& command);

[[nodiscard]] std::vector<ImportAnswers> read_answers_text(std::string_view text, const std::string& name);
[[nodiscard]] std::string answers_text(const std::vector<ImportAnswers>& imports);
// A missing file: none.
[[nodiscard]] std::vector<ImportAnswers> read_answers(const std::filesystem::path& file);

// Puts them in front, in place of earlier ones of the same path; drops the oldest if there are too many.
[[nodiscard]] std::vector<ImportAnswers> with_answers(std::vector<ImportAnswers> imports,
                                                      ImportAnswers newest);

// What fits a file best.
struct Recalled {
    std::map<std::string, std::string> answers;
    bool same_file = false;
    std::string name;  // of the file that was answered for
};
[[nodiscard]] std::optional<Recalled> recall(const std::vector<ImportAnswers>& imports,
                                             const ImportedFile& file);

// Fills the dialog, and marks what it filled. True: it chose another row, so the files must be examined again.
bool propose(const Recalled& recalled, bool choices, ImportForm& form);
// What the person answered; what was left as the files propose it is none.
[[nodiscard]] std::map<std::string, std::string> answers_of(const ImportForm& form);

}  // namespace tact
