// Moves requests and replies between the bus and the servo, one for one, and does for the Falcon what it does
// not do itself: enable edges, a watchdog, latched faults (hal/phantom/amplifier.hpp, fed from here).
//
// Replies   only such that were asked for; with counts that a Falcon can have and that are not farther from the
//           last ones than its legs can go. Three of those in a row are a jump: the device is started anew, and
//           its marks count again once it said that it has lost them.
// Requests  one on its way at a time, with the servo's newest torque, or kIdle after the last one. While the
//           amplifier is off, and before all encoders are homed, its torque is zero. A zero that is due by a
//           watchdog or relax() does not wait for a reply.
// Late      a reply that did not come within kReplyMax is counted and asked for again; kUnansweredMax of them
//           in a row, and the device is taken for gone
// Link      Boot after every connect; a device that is gone is looked for every kReopenEvery by its serial
// Delay     from a reply to the second one after it: its request is already answered when the torque goes out
// Thread    round() on one; read(), write() on the servo's; relax() on any
#pragma once

#include <string>

#include "hal/falcon/boot.hpp"
#include "hal/falcon/kinematics.hpp"
#include "hal/phantom/amplifier.hpp"
#include "hal/usb/pump_link.hpp"
#include "hal/usb/pump_mail.hpp"

namespace tact::falcon {

enum class Link : std::uint8_t { closed, starting, refused, open };

struct PumpCounts {
    std::uint64_t taken = 0, asked = 0, late = 0, unasked = 0;
    std::array<std::uint64_t, kPacketFaults> refused{};  // by PacketFault
    std::uint64_t far = 0;                               // counts that no leg can have gone to
    std::uint64_t jumps = 0, transfers_failed = 0, stalls = 0, reconnects = 0;
    [[nodiscard]] std::uint64_t bad() const noexcept;
};

// For people: what came and what of it was refused. Not for the servo's thread.
[[nodiscard]] std::string summary(const PumpCounts& counts);

// From the pump to the servo.
struct PumpNews {
    Reply reply;
    PumpCounts counts;
    std::uint64_t replies = 0;     // taken since the start of the program; 0: none
    std::int64_t taken_at_ns = 0;  // when the newest came
    std::int64_t delay_ns = 0;     // newest; 0: unknown
    std::uint32_t generation = 0;  // another one after every start of the link
    std::uint32_t jumps = 0;       // of encoders, so far
    Link link = Link::closed;
    BootFault boot_fault = BootFault::none;
    bool on = false, tripped = false;  // the amplifier's state
    bool last_second_bad = false;
};

// From the servo to the pump.
struct PumpOrder {
    Torque3 torque{};
    bool enable = false;
    std::uint32_t heartbeat = 0;
    std::uint32_t generation = 0, relaxed = 0;  // that it is for
    std::int64_t answers_ns = 0;                // taken_at_ns of the reply that it answers
    std::int64_t written_at_ns = 0;
};

class Pump : public usb::PumpMail<PumpNews, PumpOrder> {
public:
    static constexpr Duration kReopenEvery = usb::PumpLink::kReopenEvery;
    static constexpr Duration kIdle = std::chrono::microseconds(1500);
    static constexpr Duration kReplyMax = std::chrono::milliseconds(8);
    static constexpr Duration kPoll = std::chrono::microseconds(50);  // for an order that is due
    static constexpr unsigned kUnansweredMax = 50, kFarMax = 3;
    static constexpr double kLegRadS = 60.0;  // twice what a quick hand makes of a leg

    Pump(usb::Bus& bus, std::string serial, double rad_per_count);

    // Before open().
    void give(std::vector<std::byte> firmware) { boot_.give(std::move(firmware)); }

    // Start-up: one try to open the bus. From then on round() keeps it open.
    [[nodiscard]] usb::BusFinding open();
    // What is due, then what comes within about `patience`.
    void round(Duration patience) noexcept;
    [[nodiscard]] Duration patience() const noexcept;
    // No torque on the wire, or no wire.
    [[nodiscard]] bool quiet() const noexcept;
    void close() noexcept { link_.bus().close(); }

private:
    [[nodiscard]] std::uint32_t us() noexcept;
    [[nodiscard]] bool homed() const noexcept { return news_.reply.homed == kHomedAll; }
    void connected(Instant now, bool anew) noexcept;
    void lose(Instant now) noexcept;
    void follow_boot(Instant now) noexcept;
    void look_at_replies(Instant now) noexcept;
    void apply(bool enable, std::uint32_t heartbeat, const Torque3& torque) noexcept;
    void take_order(Instant now) noexcept;
    void send_due(Instant now) noexcept;
    [[nodiscard]] Torque3 torque() const noexcept;
    void take(const usb::BusEvent& event) noexcept;
    void take_bytes(std::span<const std::byte> bytes, Instant at) noexcept;
    void take_reply(Reply reply, Instant at) noexcept;
    [[nodiscard]] bool possible(const Reply& reply, Instant at) const noexcept;

    usb::PumpLink link_;
    usb::BadSeconds seconds_;
    Boot boot_;
    double counts_per_s_;  // the most that a leg makes

    PumpNews news_;
    ReplyStream stream_;
    phantom::Amplifier amplifier_;
    std::uint32_t sequence_ = 0, relaxed_seen_ = 0;
    unsigned owed_ = 0;  // replies
    unsigned unanswered_ = 0, far_ = 0;
    bool sending_ = false, due_ = false, known_ = false;
    bool moved_ = false;    // there is torque on the wire
    bool doubted_ = false;  // what the encoders call their marks, until one of them has none
    Instant asked_at_{}, taken_at_{}, restart_at_{};
    std::int64_t answers_ns_ = 0, sent_answers_ns_ = 0, last_answers_ns_ = 0;
};

}  // namespace tact::falcon
