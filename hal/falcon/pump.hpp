// Exchanges requests and replies between bus and servo, one for one, and adds the functions that the Falcon
// lacks: enable edges, a watchdog, latched faults (hal/phantom/amplifier.hpp).
//
// Replies   accepted only when requested, with possible counts that are no farther from the last ones than
//           the legs can move. Three impossible ones in a row are a jump: the device restarts, and its
//           marks are valid again only after it has reported them lost.
// Requests  one at a time, with the servo's newest torque, or kIdle after the last one. While the amplifier
//           is off, and before all encoders are homed, the torque is zero. A zero due to a watchdog or
//           relax() does not wait for a reply.
// Late      a reply later than kReplyMax is counted and requested again; after kUnansweredMax of them in a
//           row the device counts as disconnected
// Link      Boot after every connect; a missing device is searched by its serial number every kReopenEvery
// Delay     from a reply to the second one after it: its request is already answered when the torque goes
//           out
// Thread    round() on one; read(), write() on the servo thread; relax() on any
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
    std::uint64_t far = 0;                               // counts that no leg can have reached
    std::uint64_t jumps = 0, transfers_failed = 0, stalls = 0, reconnects = 0;
    [[nodiscard]] std::uint64_t bad() const noexcept;
};

// Text for people: replies received and refused. Not for the servo thread.
[[nodiscard]] std::string summary(const PumpCounts& counts);

// From the pump to the servo.
struct PumpNews {
    Reply reply;
    PumpCounts counts;
    std::uint64_t replies = 0;     // received since the start of the program
    std::int64_t taken_at_ns = 0;  // time of the newest reply
    std::int64_t delay_ns = 0;     // newest; 0: unknown
    std::uint32_t generation = 0;  // changes with every start of the link
    std::uint32_t jumps = 0;       // of encoders, since the start
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
    std::uint32_t generation = 0, relaxed = 0;  // that the order is for
    std::int64_t answers_ns = 0;                // taken_at_ns of the reply that it answers
    std::int64_t written_at_ns = 0;
};

class Pump : public usb::PumpMail<PumpNews, PumpOrder> {
public:
    static constexpr Duration kReopenEvery = usb::PumpLink::kReopenEvery;
    static constexpr Duration kIdle = std::chrono::microseconds(1500);
    static constexpr Duration kReplyMax = std::chrono::milliseconds(8);
    static constexpr Duration kPoll = std::chrono::microseconds(50);  // when an order is due
    static constexpr unsigned kUnansweredMax = 50, kFarMax = 3;
    static constexpr double kLegRadS = 60.0;  // twice the leg speed of a quick hand

    Pump(usb::Bus& bus, std::string serial, double rad_per_count);

    // Sets the firmware; before open().
    void give(std::vector<std::byte> firmware) { boot_.give(std::move(firmware)); }

    // Start-up: one attempt to open the bus. After that, round() keeps it open.
    [[nodiscard]] usb::BusFinding open();
    // Sends due requests, then receives for about `patience`.
    void round(Duration patience) noexcept;
    [[nodiscard]] Duration patience() const noexcept;
    // True: the last torque sent is zero, or there is no link.
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
    double counts_per_s_;  // largest speed of a leg

    PumpNews news_;
    ReplyStream stream_;
    phantom::Amplifier amplifier_;
    std::uint32_t sequence_ = 0, relaxed_seen_ = 0;
    unsigned owed_ = 0;  // outstanding replies
    unsigned unanswered_ = 0, far_ = 0;
    bool sending_ = false, due_ = false, known_ = false;
    bool moved_ = false;    // a non-zero torque was sent
    bool doubted_ = false;  // the reported marks are not trusted until an encoder reports its mark as lost
    Instant asked_at_{}, taken_at_{}, restart_at_{};
    std::int64_t answers_ns_ = 0, sent_answers_ns_ = 0, last_answers_ns_ = 0;
};

}  // namespace tact::falcon
