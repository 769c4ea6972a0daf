// An arm with its amplifier board and a hand on it, behind PROTOCOL.md's packets and without a bus: what the
// emulator plugs into the kernel, and what tests put under the driver.
//
// In, out   packets as they lie on the wire; the board paces its states by its own clock
// Physics   SimHand, moved by what the motors push less the arm's weight; with the amplifier off the fingers
//           carry the weight. Encoders in whole counts from wherever they stood at power-on.
// Heat      the motors' windings warm up; beyond their limit the board says over-temperature
// Ritual    the person holds the arm in its calibration pose until the PC spoke, presses button 0, then takes
//           it to where the hand is and lets go; without it the hand moves from the start
// Clock     now_us is the board's, wraps; tick() every half period or more often
// Fails by  StartupError for figures that make no arm; otherwise as told by its faults
// Thread    one; allocates nothing after its construction
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "hal/arm/arm_kinematics.hpp"
#include "hal/phantom/amplifier.hpp"
#include "hal/sim/sim_hand.hpp"

namespace tact::emu {

struct BoardSettings {
    ArmParameterSet arm = arm_parameter_set("premium-1.5");
    SimHandSettings hand;
    std::string serial = "EMU-1", model = "Tact emulator";  // printable, at most 16 characters
    std::uint16_t rate_hz = 1000, watchdog_ms = 10;
    std::uint16_t boot = 1;
    Counts6 power_on{1200, -340, 77, 15, -9, 4};  // what the encoders show in the calibration pose
    bool ritual = true;
    double ritual_slow = 1.0;  // takes so many times as long
};

// What is wrong now. Plain data: set what you want through faults().
struct BoardFaults {
    std::uint16_t causes = 0;       // of phantom::status::kFaults: brown-out, over-temperature, ...
    bool count_lost = false;        // an encoder skipped
    bool frozen = false;            // sends nothing and hears nothing
    bool deaf = false;              // takes no commands, goes on sending
    int stuck_encoder = -1;         // keeps its count
    Counts6 jump{};                 // added to the counts
    int dead_drive = -1;            // this motor's current stays 0
    unsigned corrupt = 0;           // so many of the next states have a bit turned over
    unsigned repeat = 0, drop = 0;  // come twice, do not come
    unsigned reorder = 0;           // come after the one behind them
};

class EmulatedBoard {
public:
    explicit EmulatedBoard(const BoardSettings& settings);

    // A packet from the PC, as it came.
    void receive(std::span<const std::byte> bytes, std::uint32_t now_us) noexcept;
    void tick(std::uint32_t now_us) noexcept;
    // The next packet for the PC. False: none. One that nobody fetches makes room for newer ones.
    bool next_packet(std::array<std::byte, 64>& packet, std::size_t& size) noexcept;
    // Power off and on: another boot, other counts, no version spoken, the ritual anew.
    void restart(std::uint32_t now_us) noexcept;

    [[nodiscard]] BoardFaults& faults() noexcept { return faults_; }
    // The person takes the arm back to its calibration pose, and the ritual comes anew.
    void calibrate_again() noexcept;
    // Of the person: button bits besides the ritual's own; the stylus in the inkwell.
    void press(std::uint16_t buttons) noexcept { pressed_ = buttons; }

    // The hand goes there, device frame, and rests; none: it does as before.
    void hold(const std::optional<Vec3>& at_dev_m) noexcept { hand_.hold(at_dev_m); }

    [[nodiscard]] const phantom::Amplifier& amplifier() const noexcept { return amplifier_; }
    [[nodiscard]] const ArmKinematics& arm() const noexcept { return arm_; }
    [[nodiscard]] Pose tool_pose() const noexcept;  // where the tip really is, device frame
    [[nodiscard]] const Wrench& shown() const noexcept { return shown_; }  // by the motors, at the tip
    [[nodiscard]] bool hand_free() const noexcept;                         // the ritual is over
    [[nodiscard]] double hottest_c() const noexcept;
    [[nodiscard]] std::uint64_t unfetched() const noexcept { return unfetched_; }

private:
    struct Packet {
        std::array<std::byte, 64> bytes{};
        std::size_t size = 0;
    };
    void move(std::uint32_t now_us) noexcept;
    void step(double dt_s) noexcept;
    void send_state(std::uint32_t now_us) noexcept;
    void put(std::span<const std::byte> bytes) noexcept;
    [[nodiscard]] double ritual_s() const noexcept;
    [[nodiscard]] phantom::State state(std::uint32_t now_us) noexcept;
    [[nodiscard]] std::array<std::int16_t, 6> flowing_ma() const noexcept;

    BoardSettings settings_;
    ArmKinematics arm_;
    std::array<std::uint16_t, 6> max_ma_{};
    phantom::Info info_;
    phantom::Amplifier amplifier_;
    SimHand hand_;
    BoardFaults faults_;
    std::array<MotorHeat, 6> heat_{};
    Wrench shown_;
    Counts6 zero_{}, sent_counts_{};
    bool spoken_ = false, started_ = false;
    std::uint16_t boot_, pressed_ = 0;
    std::uint32_t sequence_ = 0, moved_us_ = 0, due_us_ = 0;
    std::int64_t ritual_us_ = 0;
    std::uint64_t unfetched_ = 0;

    static constexpr std::size_t kQueue = 3;  // old states are worth nothing
    std::array<Packet, kQueue> queue_{};
    std::size_t first_ = 0, count_ = 0;
    Packet held_back_, answer_;
};

}  // namespace tact::emu
