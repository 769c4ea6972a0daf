// An emulated head with a tracker, as the frames that the tracker's gateway sends on the CAN bus.
//
// Head     a random sum of sines about its place in front of the screen; the sensors are 0.1 m apart
// Noise    that of an electromagnetic tracker: stated at kNoiseAtM from its origin, growing with
//          distance^3.5
// Time     from the given clock: the frames of a period are sent when due, `latency` after the measurement.
//          A pause longer than kBacklog periods loses the older ones, as a kernel's queue does.
// Thread   receive() and reopen() on one; inject(), hold() and let_go() on any: a sample may mix two places
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/tracker/can_reader.hpp"
#include "ipc/base/random.hpp"

namespace tact {

struct SimHeadSettings {
    CanTrackerSettings can;
    std::uint64_t seed = 1;
    Vec3 rest_m{0.0, 0.1, 0.6};  // in the tracker's frame
    double sway_m = 0.05;        // amplitude
    double turn_rad = 0.3;
    double noise_m = 0.8e-3;    // standard deviation per axis
    double noise_rad = 2.6e-3;  // 0.15 degrees
};

// Faults that tests can inject at any time.
enum class TrackerFault : std::uint8_t {
    none,
    silent,
    corrupt,       // every frame has a bit error
    not_a_number,  // the tracker's own pose is NaN
    out_of_range,  // the pose jumps to the end of the layout's range
    flood,         // the newest frame repeats as fast as it is received
    bus_off,
    down,
    gone,
};

class SimHead {
public:
    explicit SimHead(const SimHeadSettings& settings);
    [[nodiscard]] Pose at(unsigned sensor, Instant when) const noexcept;

private:
    struct Wave {
        double rate_rad_s, phase_rad, weight;
    };
    Vec3 rest_m_;
    double sway_m_, turn_rad_;
    std::array<std::array<Wave, 3>, 6> waves_{};
};

class SimHeadBus final : public CanSource {
public:
    static constexpr unsigned kBacklog = 8;
    static constexpr double kNoiseAtM = 0.76;

    SimHeadBus(const SimHeadSettings& settings, Clock& clock);

    void open() override;
    bool reopen() noexcept override;
    CanBatch receive(std::span<CanFrame> into, Duration patience) noexcept override;

    // Holds sensor 0 at this place in the tracker's frame, as at the marks of a screen; the other sensors beside it.
    void hold(const Vec3& at_m) noexcept;
    void let_go() noexcept { held_.store(false, std::memory_order_relaxed); }
    void inject(TrackerFault fault) noexcept { fault_.store(fault, std::memory_order_relaxed); }
    [[nodiscard]] const SimHead& head() const noexcept { return head_; }

private:
    [[nodiscard]] Pose measured(unsigned sensor, Instant when) const noexcept;
    [[nodiscard]] Vec3 noise(double deviation) noexcept;
    void measure(TrackerFault fault) noexcept;
    void queue(const CanFrame& frame) noexcept { frames_[queued_++] = frame; }
    [[nodiscard]] bool tell_of(TrackerFault fault, CanBatch& batch) noexcept;

    SimHeadSettings settings_;
    Clock& clock_;
    SimHead head_;
    SeededRandom random_;
    Duration period_;
    std::atomic<TrackerFault> fault_{TrackerFault::none};
    std::atomic<bool> held_{false};
    std::array<std::atomic<double>, 3> held_m_{};
    TrackerFault told_ = TrackerFault::none;
    bool open_ = false;
    Instant start_{}, due_{};
    std::uint32_t counter_ = 0;
    std::array<CanFrame, 2 + 2 * kTrackerSensorsMax>
        frames_{};  // of one period, plus error frames of the controller
    std::size_t queued_ = 0, given_ = 0;
};

}  // namespace tact
