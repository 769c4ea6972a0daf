// Writes the visible traces as a table, in the background.
//
// Thread   follow() and finish() on the frame thread; a low-priority thread formats and writes
// File     CSV of trace_csv(); written completely or not at all.  Fails by a message in TracesState
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "gui/dashboard/traces.hpp"

namespace tact {

class TraceExport {
public:
    TraceExport() = default;
    ~TraceExport();
    TraceExport(const TraceExport&) = delete;
    TraceExport& operator=(const TraceExport&) = delete;

    // Call once a frame: starts a requested export and reports its result.
    void follow(TracesState& traces);
    // Waits for an export in progress.
    void finish();

private:
    void start(const TracesState& traces);

    std::thread thread_;
    std::atomic<bool> done_{false};
    std::string message_;
    Grade grade_ = Grade::unknown;
};

// Throws StartupError.
void write_whole_file(const std::string& path, const std::string& text);

}  // namespace tact
