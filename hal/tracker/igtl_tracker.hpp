// The head tracker behind an OpenIGTLink server, such as PLUS or 3D Slicer: an IgtlReader on its own thread.
//
// Thread   "igtl", FIFO 70 where permitted, else ordinary; never the servo's. It wakes for bytes or every
//          10 ms, and blocks all signals.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hal/tracker/igtl_reader.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

class IgtlTracker final : public Tracker {
public:
    static constexpr int kPriority = 70;

    IgtlTracker(const IgtlTrackerSettings& settings, const std::string& host, int port);
    // With any source of bytes; `name` is for people.
    IgtlTracker(const IgtlTrackerSettings& settings, std::unique_ptr<IgtlSource> source, std::string name);
    ~IgtlTracker() override;
    IgtlTracker(const IgtlTracker&) = delete;
    IgtlTracker& operator=(const IgtlTracker&) = delete;

    TrackerInfo open() override;
    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT override;
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT override;

private:
    void live() noexcept;

    IgtlTrackerSettings settings_;
    std::string name_;
    std::unique_ptr<IgtlSource> source_;
    ServoClock clock_{Duration{0}};  // no spinning
    IgtlReader reader_;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
