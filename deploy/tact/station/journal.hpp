// The journal of tact station setup: what has to be done to take it back. Written before each step.
//
// Place   ROOT/var/lib/tact/station.json, mode 0600: undo writes system files from it, so it is refused where anybody
//         but its owner may write to it, or where it belongs to a user other than root and the one who calls.
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
    std::vector<Command> undo_first{};  // commands, before and
    std::vector<Command> undo{};        // after the files are as before
};

struct Journal {
    int core = -1;
    std::string kernel_arguments{};
    bool complete = false;                         // the whole set-up
    std::vector<std::filesystem::path> folders{};  // made for the journal itself
    std::vector<JournalStep> steps{};
};

inline constexpr const char* kJournalPath = "/var/lib/tact/station.json";

[[nodiscard]] std::string journal_text(const Journal& journal);
// Throws StartupError for what is no journal.
[[nodiscard]] Journal parse_journal(const std::string& text);

// Nothing: there is none. Throws StartupError where it is damaged or may not be trusted.
[[nodiscard]] std::optional<Journal> read_journal(const std::filesystem::path& root);
void write_journal(const std::filesystem::path& root, const Journal& journal);
void remove_journal(const std::filesystem::path& root, const Journal& journal);

}  // namespace tact::launch
