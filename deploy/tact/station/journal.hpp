// The journal of tact station setup: all that undo needs. Written before each step.
//
// Place   ROOT/var/lib/tact/station.json, mode 0600. Undo writes system files from it, so it is rejected if others than
//         its owner may write to it, or if its owner is neither root nor the caller.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/station/change.hpp"

namespace tact::launch {

using Command = std::vector<std::string>;

enum class StepState : std::uint8_t { begun, done };

struct JournalStep {
    std::string name{};
    StepState state = StepState::begun;
    std::vector<FileChange> changes{};
    std::vector<Command> undo_first{};  // commands before
    std::vector<Command> undo{};        // and after the files are restored
};

struct Journal {
    int core = -1;
    std::string kernel_arguments{};
    bool complete = false;                         // the set-up is complete
    std::vector<std::filesystem::path> folders{};  // created for the journal itself
    std::vector<JournalStep> steps{};
};

inline constexpr const char* kJournalPath = "/var/lib/tact/station.json";

[[nodiscard]] std::string journal_text(const Journal& journal);
// Throws StartupError if the text is not a journal.
[[nodiscard]] Journal parse_journal(const std::string& text);

// Empty if there is none. Throws StartupError if it is damaged or not trustworthy.
[[nodiscard]] std::optional<Journal> read_journal(const std::filesystem::path& root);
void write_journal(const std::filesystem::path& root, const Journal& journal);
void remove_journal(const std::filesystem::path& root, const Journal& journal);

}  // namespace tact::launch
