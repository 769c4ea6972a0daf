#include "deploy/tact/station/transaction.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

std::filesystem::path at(const std::filesystem::path& root, const std::filesystem::path& path) {
    return root / path.relative_path();
}

// The packages of the running kernel cannot be removed.
bool removes_running_kernel(const Command& command) {
    utsname name{};
    if (uname(&name) != 0 || std::find(command.begin(), command.end(), "purge") == command.end())
        return false;
    return std::find(command.begin(), command.end(), std::string("linux-image-") + name.release) !=
           command.end();
}

void run_or_throw(const StationTools& tools, const Command& command) {
    tools.report("  run: " + command_text(command));
    const int code = tools.run(command);
    if (code != 0)
        throw StartupError("run " + command_text(command), "exit code " + std::to_string(code),
                           "fix the problem reported above, then repeat the command");
}

void undo_step(const StationTools& tools, const JournalStep& step) {
    tools.report(step.name + ": undo");
    for (const Command& command : step.undo_first) {
        tools.report("  run: " + command_text(command));
        if (const int code = tools.run(command); code != 0)
            tools.report("  exit code " + std::to_string(code) + ", ignored");
    }
    for (auto change = step.changes.rbegin(); change != step.changes.rend(); ++change) {
        tools.report("  restore: " + change->path.string());
        revert_change(tools.root, *change);
        tools.interrupt();
    }
    for (const Command& command : step.undo) {
        if (removes_running_kernel(command)) {
            tools.report(
                "  not run, because this kernel is in use; after a restart with another kernel, run: " +
                command_text(command));
        } else if (step.state == StepState::begun) {  // the step may not have come this far
            tools.report("  run: " + command_text(command));
            if (const int code = tools.run(command); code != 0)
                tools.report("  exit code " + std::to_string(code) + ", ignored: the step was not complete");
        } else {
            run_or_throw(tools, command);
        }
        tools.interrupt();
    }
}

std::string refusal(const std::filesystem::path& root, const Journal& journal) {
    std::string all;
    for (const JournalStep& step : journal.steps)
        for (const FileChange& change : step.changes)
            if (const std::string why = changed_since(root, change); !why.empty())
                all += (all.empty() ? "" : "; ") + why;
    return all;
}

bool as_planned(const StationPlan& plan, const StationTools& tools) {
    return std::all_of(plan.steps.begin(), plan.steps.end(),
                       [&](const PlannedStep& s) { return changes_of(s, tools.root).empty(); });
}

void do_step(const PlannedStep& step, const StationTools& tools, Journal& journal) {
    JournalStep entry{.name = step.name,
                      .changes = changes_of(step, tools.root),
                      .undo_first = step.undo_first,
                      .undo = step.undo};
    tools.report(step.name + ": " + step.purpose);
    // Unchanged files need no command to be read again.
    const bool idle = entry.changes.empty() && (step.commands.empty() || !step.files.empty());
    if (idle) {
        tools.report("  already done");
        return;
    }
    journal.steps.push_back(entry);
    write_journal(tools.root, journal);
    tools.interrupt();
    for (const FileChange& change : entry.changes) {
        tools.report("  write: " + change.path.string());
        apply_change(tools.root, change, tools.interrupt);
        tools.interrupt();
    }
    for (const Command& command : step.commands) {
        run_or_throw(tools, command);
        tools.interrupt();
    }
    journal.steps.back().state = StepState::done;
    write_journal(tools.root, journal);
    tools.interrupt();
}

}  // namespace

std::string command_text(const Command& command) {
    std::string text;
    for (const std::string& argument : command) text += (text.empty() ? "" : " ") + argument;
    return text;
}

std::vector<FileChange> changes_of(const PlannedStep& step, const std::filesystem::path& root) {
    std::vector<FileChange> changes;
    std::vector<std::filesystem::path> made;  // by earlier changes
    for (const WantedFile& file : step.files) {
        FileChange change{.path = file.path,
                          .before = read_content(at(root, file.path)),
                          .after = {.kind = file.kind,
                                    .bytes = file.bytes,
                                    .mode = file.mode,
                                    .uid = geteuid(),
                                    .gid = getegid()},
                          .folders = missing_folders(root, file.path)};
        if (change.before == change.after) continue;
        std::erase_if(change.folders, [&](const auto& folder) {
            return std::find(made.begin(), made.end(), folder) != made.end();
        });
        made.insert(made.end(), change.folders.begin(), change.folders.end());
        changes.push_back(std::move(change));
    }
    return changes;
}

SetupResult set_up_station(const StationPlan& plan, const StationTools& tools) {
    if (const auto before = read_journal(tools.root)) {
        const std::string changed = refusal(tools.root, *before);
        if (!changed.empty())
            throw StartupError("set up this station", changed,
                               "restore the file, or undo the set-up with tact station undo --force");
        if (before->complete && before->core == plan.cores.servo && as_planned(plan, tools))
            return SetupResult::already_so;
        throw StartupError(
            "set up this station",
            !before->complete ? "an earlier set-up was interrupted"
            : before->core != plan.cores.servo
                ? "the station is set up differently, with core " + std::to_string(before->core)
                : "the station was set up before, and not all of it is in place",
            "run tact station undo, then repeat the command");
    }
    Journal journal{.core = plan.cores.servo,
                    .kernel_arguments = plan.kernel_arguments,
                    .folders = missing_folders(tools.root, kJournalPath)};
    write_journal(tools.root, journal);
    tools.interrupt();
    try {
        for (const PlannedStep& step : plan.steps) do_step(step, tools, journal);
        journal.complete = true;
        write_journal(tools.root, journal);
    } catch (const StartupError&) {
        tools.report("a step failed; undoing the previous steps");
        undo_station(tools, true);
        throw;
    }
    return SetupResult::done;
}

bool undo_station(const StationTools& tools, bool force) {
    std::optional<Journal> journal = read_journal(tools.root);
    if (!journal) return false;
    if (const std::string changed = refusal(tools.root, *journal); !changed.empty() && !force)
        throw StartupError(
            "undo the set-up of this station", changed,
            "save the changes that you need, then run tact station undo --force, which restores the state "
            "before the set-up");
    while (!journal->steps.empty()) {
        undo_step(tools, journal->steps.back());
        journal->steps.pop_back();
        journal->complete = false;
        write_journal(tools.root, *journal);
        tools.interrupt();
    }
    remove_journal(tools.root, *journal);
    return true;
}

}  // namespace tact::launch
