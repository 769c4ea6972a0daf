// The flight recorder: keeps the last seconds of a controller in memory and writes them to a file after an
// event.
//
// Memory   `length` of batches, or `bytes_max` when a fast loop needs more; never more
// Written  at a fault, an overrun, a command "mark" (the window's key) or save(); `after` later, so that the
//          consequences are in the file too
// Rate     a fault or a person's request always creates a file; overruns create one in kOverrunEvery at most
// Kept     `files_max` files in the folder. Of more, those of overruns are removed first, then those that a person
//          requested, then those of faults; of each the oldest
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
#include <vector>

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

// Why a batch is saved, in the order of importance.
enum class FlightCause : std::uint8_t { none, overrun, request, fault };
struct FlightReason {
    FlightCause cause = FlightCause::none;
    std::string text;
};
// The most important one in a batch.
[[nodiscard]] FlightReason reason_in(const Batch& batch);
inline constexpr Duration kOverrunEvery = std::chrono::minutes(10);

// Which of the names in a folder to remove, so that files_max recordings are left. Other names are not touched.
[[nodiscard]] std::vector<std::string> surplus_flights(std::vector<std::string> names, std::size_t files_max);

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
