// Moves packets between the bus and the servo: bounded rounds, counters of everything refused, the newest
// value in each direction. It makes no decision about forces and passes on accepted packets only.
//
// States    accepted by the rules of PROTOCOL.md, stamped in machine time; the newest replaces older ones
// Commands  the newest replaces older ones, one transfer at a time; only for the connection that the servo
//           knows (generation), and never one from before the last relax()
// Link      Query and Info after every connect, and again when the board falls silent or restarts; a
//           missing board is searched by its serial number every kReopenEvery
// Delay     from a state to the first one that shows its command as accepted, by the board's own clock: the
//           time from the encoders to the motors, rounded up to whole states
// Thread    round() on one; read(), write() on the servo thread; relax() on any
#pragma once

#include <array>
#include <string>

#include "hal/phantom/packets.hpp"
#include "hal/phantom/pump_counts.hpp"
#include "hal/tracker/tracker_clock.hpp"
#include "hal/usb/pump_link.hpp"
#include "hal/usb/pump_mail.hpp"

namespace tact::phantom {

enum class Link : std::uint8_t { closed, asking, refused, open };

// Reason for which the newest connection was refused.
enum class LinkRefusal : std::uint8_t { none, version, serial, metrics };

// From the pump to the servo.
struct PumpNews {
    State state;
    Info info;
    PumpCounts counts;
    std::uint64_t states = 0;          // accepted since the start of the program
    std::int64_t taken_at_ns = 0;      // time at which the counts were latched, machine time
    std::int64_t behind_since_ns = 0;  // the board is more than 5 commands behind since; 0: it is not
    std::int64_t delay_ns = 0;         // newest; 0: unknown
    std::uint32_t generation = 0;      // changes with every connect and every start of the board
    Link link = Link::closed;
    LinkRefusal refusal = LinkRefusal::none;
    bool seen_known = false, seen_enable = false;  // of the newest command that the state acknowledges
    std::array<std::int16_t, 6> seen_ma{};
    bool last_second_bad = false;
};

// From the servo to the pump.
struct PumpOrder {
    std::array<std::int16_t, 6> current_ma{};
    bool enable = false;
    std::uint32_t heartbeat = 0;
    std::uint32_t generation = 0, relaxed = 0;  // that the order is for
    std::uint32_t state_us = 0;                 // board's clock in the state that it answers
    std::int64_t written_at_ns = 0;
};

class UsbPump : public usb::PumpMail<PumpNews, PumpOrder> {
public:
    static constexpr Duration kReopenEvery = usb::PumpLink::kReopenEvery;
    static constexpr Duration kAskEvery = std::chrono::milliseconds(100);
    static constexpr Duration kSilence = std::chrono::milliseconds(50);  // or longer, see below
    static constexpr Duration kPoll = std::chrono::microseconds(50);     // when a command is due
    static constexpr Duration kWatchdogMax = std::chrono::milliseconds(100);
    static constexpr std::uint32_t kBehindMax = 5;

    // A board whose watchdog is longer than watchdog_max is refused. One that sent no state for `silence`
    // is queried again; `silence` is not shorter than the permitted age of a state, since queries displace
    // commands.
    UsbPump(usb::Bus& bus, std::string serial, Duration watchdog_max = kWatchdogMax,
            Duration silence = kSilence)
        : link_(bus, std::move(serial)), watchdog_max_(watchdog_max), silence_(silence) {}

    // Start-up: one attempt to open the bus. After that, round() keeps it open.
    [[nodiscard]] usb::BusFinding open();
    // Sends due packets, then receives for about `patience`.
    void round(Duration patience) noexcept;
    // Longest wait of the next round: until a command is due.
    [[nodiscard]] Duration patience() const noexcept;
    // True: the last command sent has zero currents, or there is no link.
    [[nodiscard]] bool quiet() const noexcept;
    void close() noexcept { link_.bus().close(); }

private:
    struct Sent {
        std::uint32_t sequence = 0, state_us = 0;
        bool enable = false, answers = false;
        std::array<std::int16_t, 6> current_ma{};
    };

    void connected(Instant now) noexcept;
    void lose(Instant now) noexcept;
    void send_due(Instant now) noexcept;
    void send(const Command& command, const PumpOrder& order) noexcept;
    void take(const usb::BusEvent& event) noexcept;
    void take_packet(const usb::BusEvent& event) noexcept;
    void take_info(const Info& info, Instant at) noexcept;
    void take_state(const State& state, Instant at) noexcept;
    void look_at_seen(Instant at) noexcept;
    void count_second(Instant now) noexcept;

    usb::PumpLink link_;
    usb::BadSeconds seconds_;
    Duration watchdog_max_, silence_;

    PumpNews news_;
    SequenceGate gate_;
    SequenceGate::Counts before_;  // of the earlier connections
    TrackerClock board_clock_{std::chrono::milliseconds(50)};
    Instant taken_at_{}, heard_at_{}, asked_at_{};
    std::uint32_t sequence_ = 0, relaxed_sent_ = 0, heartbeat_ = 0;
    std::uint8_t board_refused_ = 0;
    unsigned unanswered_ = 0;
    bool sending_ = false, known_ = false;  // known: Info arrived over this connection
    bool query_due_ = false, relax_sending_ = false;
    std::uint32_t relax_wanted_ = 0;
    static constexpr std::size_t kRing = 64;
    std::array<Sent, kRing> sent_{};
    std::uint32_t seen_ = 0;
};

}  // namespace tact::phantom
