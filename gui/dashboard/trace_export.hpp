// Writes what is seen of the traces as a table, beside the frame loop.
//
// Thread   start() and poll() on the frame thread; one of low priority formats and writes
// File     CSV of trace_csv(); appears whole or not at all.  Fails by words
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

    // Once a frame: starts what was asked for, says what became of it.
    void follow(TracesState& traces);
    // Waits for what is under way.
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
