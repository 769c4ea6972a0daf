// An emulated arm with its amplifier board and a hand on it, behind PROTOCOL.md's packets and without a bus. The
// emulator connects it to the kernel; tests connect it to the driver.
//
// In, out   packets as on the wire; the board times its states by its own clock
// Physics   SimHand, moved by the motors' force minus the arm's weight; with the amplifier off the fingers carry the
//           weight. Encoder counts are whole numbers from an arbitrary value at power-on.
// Heat      the motors' windings heat up; above their limit the board reports over-temperature
// Ritual    the person holds the arm in its calibration pose until the PC has sent a command, presses button 0,
//           then moves it to the hand's position and releases it; without the ritual the hand moves from the start
// Clock     now_us is the board's, wraps; tick() at least every half period
// Fails by  StartupError for invalid arm parameters; otherwise by its injected faults
// Thread    one; no allocation after construction
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
    Counts6 power_on{1200, -340, 77, 15, -9, 4};  // encoder counts in the calibration pose
    bool ritual = true;
    double ritual_slow = 1.0;  // factor on the duration
};

// Active faults. Plain data; set them through faults().
struct BoardFaults {
    std::uint16_t causes = 0;       // of phantom::status::kFaults: brown-out, over-temperature, ...
    bool count_lost = false;        // an encoder lost counts
    bool frozen = false;            // neither sends nor receives
    bool deaf = false;              // receives no commands, still sends
    int stuck_encoder = -1;         // index of an encoder with a constant count
    Counts6 jump{};                 // added to the counts
    int dead_drive = -1;            // index of a motor whose current stays 0
    unsigned corrupt = 0;           // number of next states with a flipped bit
    unsigned repeat = 0, drop = 0;  // number of next states that are repeated, dropped
    unsigned reorder = 0;           // number of next states that swap with their successor
};

class EmulatedBoard {
public:
    explicit EmulatedBoard(const BoardSettings& settings);

    // Receives a packet from the PC.
    void receive(std::span<const std::byte> bytes, std::uint32_t now_us) noexcept;
    void tick(std::uint32_t now_us) noexcept;
    // The next packet for the PC. False: none. Packets that are not fetched make room for newer ones.
    bool next_packet(std::array<std::byte, 64>& packet, std::size_t& size) noexcept;
    // Power cycle: another boot, other counts, no version sent, a new ritual.
    void restart(std::uint32_t now_us) noexcept;

    [[nodiscard]] BoardFaults& faults() noexcept { return faults_; }
    // The person returns the arm to its calibration pose and repeats the ritual.
    void calibrate_again() noexcept;
    // By the person: button bits in addition to the ritual's; the stylus in the inkwell.
    void press(std::uint16_t buttons) noexcept { pressed_ = buttons; }

    // The hand moves to the position (device frame) and rests there; none: it continues as before.
    void hold(const std::optional<Vec3>& at_dev_m) noexcept { hand_.hold(at_dev_m); }

    [[nodiscard]] const phantom::Amplifier& amplifier() const noexcept { return amplifier_; }
    [[nodiscard]] const ArmKinematics& arm() const noexcept { return arm_; }
    [[nodiscard]] Pose tool_pose() const noexcept;  // true pose of the tip, device frame
    [[nodiscard]] const Wrench& shown() const noexcept { return shown_; }  // wrench of the motors at the tip
    [[nodiscard]] bool hand_free() const noexcept;                         // the ritual has ended
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

    static constexpr std::size_t kQueue = 3;  // old states are worthless
    std::array<Packet, kQueue> queue_{};
    std::size_t first_ = 0, count_ = 0;
    Packet held_back_, answer_;
};

}  // namespace tact::emu
