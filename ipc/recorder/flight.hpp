// The flight recorder: keeps the last seconds of a controller in memory and writes them to a file after an
// event.
//
// Memory   `length` of batches, or `bytes_max` when a fast loop needs more; never more
// Written  at a fault, an overrun, a command "mark" (the window's key) or save(); `after` later, so that the
//          consequences are in the file too. A cause within `length` of the previous one is mostly in that
//          file, and creates no new one.
// Kept     the newest `files_max` files in the folder; older ones are removed
// Thread   one
// Errors   StartupError if the folder is unusable; a file that cannot be written is reported, and recording
//          continues
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/recorder/drain.hpp"

namespace tact::record {

// The last batches in memory.
class FlightTape {
public:
    FlightTape(Duration length, std::size_t bytes_max) : length_(length), bytes_max_(bytes_max) {}
    void add(Batch&& batch);
    [[nodiscard]] const std::deque<Batch>& batches() const { return batches_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] double length_s() const;           // from its first cycle to its last
    [[nodiscard]] std::uint64_t first_step() const;  // 0: no step

private:
    void shorten();
    Duration length_;
    std::size_t bytes_max_, bytes_ = 0;
    std::deque<Batch> batches_;
};

// The reason to save a batch; empty: none.
[[nodiscard]] std::string cause_in(const Batch& batch);

struct FlightSettings {
    std::filesystem::path folder;
    std::string session = "default";
    std::string program;
    Duration length = std::chrono::seconds(30);
    Duration after = std::chrono::seconds(1);
    std::size_t bytes_max = std::size_t{256} << 20U;
    std::size_t files_max = 20;
    double seconds = 0.0, wait_s = 0.0;  // see RecorderSettings
    std::function<bool()> stop = [] { return false; };
    std::function<bool()> save = [] { return false; };  // true once per request
};

struct FlightOutcome {
    std::uint64_t files = 0, failed = 0, dropped = 0;
    bool began = false;
};

// say: reports each file with its cause, and failures.
FlightOutcome fly(const FlightSettings& settings, const std::function<void(const std::string&)>& say);

}  // namespace tact::record
