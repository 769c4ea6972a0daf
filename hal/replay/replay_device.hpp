// A recorded device: read() returns the samples set by give(), and write() keeps the commands. No person
// holds it.
//
// Thread  that of the loop, in lockstep; give() before each cycle
// Errors  those of the recorded device
#pragma once

#include "hal/api/haptic_device.hpp"
#include "hal/api/lines.hpp"

namespace tact {

class ReplayDevice final : public HapticDevice {
public:
    explicit ReplayDevice(DeviceInfo info) : info_(std::move(info)) {}

    // Sets the results of the next read() and write().
    void give(const DeviceSample& sample, IoStatus read_status, IoStatus write_status) noexcept {
        sample_ = sample;
        read_status_ = read_status;
        write_status_ = write_status;
    }
    [[nodiscard]] const DeviceCommand& sent() const noexcept { return sent_; }

    DeviceInfo open() override { return info_; }
    IoStatus read(DeviceSample& newest, Instant /*now*/) noexcept TACT_RT override {
        newest = sample_;
        return read_status_;
    }
    IoStatus write(const DeviceCommand& command, Instant /*now*/) noexcept TACT_RT override {
        sent_ = command;
        return write_status_;
    }
    void relax() noexcept override { sent_ = {}; }

private:
    DeviceInfo info_;
    DeviceSample sample_;
    IoStatus read_status_ = IoStatus::ok, write_status_ = IoStatus::ok;
    DeviceCommand sent_;
};

// Recorded safety inputs. Outputs are discarded.
class ReplayLines final : public Lines {
public:
    void give(const LinesSample& sample) noexcept { sample_ = sample; }

    LinesInfo open() override { return {.name = "recorded safety inputs"}; }
    bool read(LinesSample& newest, Instant /*now*/) noexcept TACT_RT override {
        newest = sample_;
        return sample_.sequence != 0;
    }
    void write(const LinesCommand& /*command*/, Instant /*now*/) noexcept TACT_RT override {}
    void drop() noexcept override {}
    [[nodiscard]] LinesHealth health() const noexcept TACT_RT override { return {}; }

private:
    LinesSample sample_;
};

}  // namespace tact
