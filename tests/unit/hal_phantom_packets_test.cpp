// Packets of an arm's board: round trips, layout, single-bit errors, order, versions, and the amplifier's state machine.
#include "hal/phantom/packets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hal/phantom/amplifier.hpp"

namespace tact::phantom::hal_phantom_packets_test {
namespace {

template <class T>
T drawn() {
    return *rc::gen::arbitrary<T>();
}

template <class T>
void fill(std::array<T, 6>& values) {
    for (T& v : values) v = drawn<T>();
}

State drawn_state() {
    State s;
    s.sequence = drawn<std::uint32_t>();
    s.time_us = drawn<std::uint32_t>();
    s.command_seen = drawn<std::uint32_t>();
    fill(s.counts);
    fill(s.current_ma);
    s.status = drawn<std::uint16_t>() & status::kAll;
    s.inputs = drawn<std::uint16_t>() & input::kAll;
    s.boot = drawn<std::uint16_t>();
    s.commands_refused = drawn<std::uint8_t>();
    return s;
}

Command drawn_command() {
    Command c;
    c.sequence = drawn<std::uint32_t>();
    c.heartbeat = drawn<std::uint32_t>();
    fill(c.current_ma);
    c.enable = drawn<bool>();
    c.boot = drawn<std::uint16_t>();
    return c;
}

Info an_info() {
    Info i;
    std::copy_n("PREM15-0042", 11, i.serial.begin());
    std::copy_n("premium-1.5-6dof", 16, i.model.begin());
    i.current_ma_max.fill(5500);
    i.boot = 7;
    return i;
}

template <class Packet>
void every_flipped_bit_is_refused(const Packet& packet) {
    auto bytes = encode(packet);
    Packet out;
    ASSERT_EQ(decode(bytes, out), PacketFault::none);
    ASSERT_EQ(out, packet);
    Packet untouched{};
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
        Packet kept{};
        EXPECT_NE(decode(bytes, kept), PacketFault::none) << bit;
        EXPECT_EQ(kept, untouched) << bit;
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    }
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_EQ(decode(std::span(bytes).first(size), out), PacketFault::size);
    }
    std::vector<std::byte> longer(bytes.begin(), bytes.end());
    longer.push_back(std::byte{0});
    EXPECT_EQ(decode(longer, out), PacketFault::size);
}

TEST(Packets, round_trip_unchanged) {
    EXPECT_TRUE(rc::check([] {
        const State s = drawn_state();
        State s_out;
        RC_ASSERT(decode(encode(s), s_out) == PacketFault::none);
        RC_ASSERT(s_out == s);
        const Command c = drawn_command();
        Command c_out;
        RC_ASSERT(decode(encode(c), c_out) == PacketFault::none);
        RC_ASSERT(c_out == c);
    }));
}

TEST(Packets, every_single_flipped_bit_and_every_wrong_size_is_refused) {
    EXPECT_TRUE(rc::check([] {
        every_flipped_bit_is_refused(drawn_state());
        every_flipped_bit_is_refused(drawn_command());
    }));
    every_flipped_bit_is_refused(Query{1, 3});
    every_flipped_bit_is_refused(an_info());
}

TEST(Packets, match_the_documented_layout) {
    State s;
    s.sequence = 0x04030201;
    s.counts[0] = -2;
    s.current_ma[5] = 0x1234;
    s.status = status::kAmplifierOn;
    s.inputs = input::kInkwell;
    s.boot = 0xBEEF;
    const auto b = encode(s);
    const auto at = [&b](std::size_t i) { return static_cast<unsigned>(b[i]); };
    EXPECT_EQ(b.size(), 64U);
    EXPECT_EQ(at(0), 'T');
    EXPECT_EQ(at(1), 'A');
    EXPECT_EQ(at(2), 1U);
    EXPECT_EQ(at(3), 1U);
    EXPECT_EQ(at(4), 0x01U);
    EXPECT_EQ(at(7), 0x04U);
    EXPECT_EQ(at(16), 0xFEU);
    EXPECT_EQ(at(19), 0xFFU);
    EXPECT_EQ(at(50), 0x34U);
    EXPECT_EQ(at(52), 2U);
    EXPECT_EQ(at(55), 1U);
    EXPECT_EQ(at(56), 0xEFU);
    EXPECT_EQ(encode(Command{}).size(), 32U);
}

// A slow reference, bit by bit, from the polynomial; "123456789" gives 0xCBF43926.
std::uint32_t slow_crc(std::span<const std::byte> bytes) {
    std::uint32_t c = 0xFFFFFFFFU;
    for (const std::byte b : bytes) {
        for (unsigned k = 0; k < 8; ++k) {
            const bool one = ((c ^ (static_cast<unsigned>(b) >> k)) & 1U) != 0;
            c = (c >> 1U) ^ (one ? 0xEDB88320U : 0U);
        }
    }
    return ~c;
}

TEST(Packets, their_checksum_is_the_common_crc_32) {
    const std::string digits = "123456789";
    EXPECT_EQ(slow_crc(std::as_bytes(std::span(digits))), 0xCBF43926U);
    State s;
    s.sequence = 99;
    const auto b = encode(s);
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < 4; ++i) found |= static_cast<std::uint32_t>(b[60 + i]) << (8 * i);
    EXPECT_EQ(found, slow_crc(std::span(b).first(60)));
}

template <std::size_t N>
void reseal(std::array<std::byte, N>& b) {
    const std::uint32_t c = slow_crc(std::span(b).first(N - 4));
    for (std::size_t i = 0; i < 4; ++i) b[N - 4 + i] = static_cast<std::byte>((c >> (8 * i)) & 0xFFU);
}

TEST(Packets, a_valid_checksum_does_not_excuse_a_wrong_kind_version_or_reserved_bit) {
    State s;
    Command c;
    Info i;
    auto b = encode(State{});
    b[2] = std::byte{2};
    reseal(b);
    EXPECT_EQ(decode(b, s), PacketFault::version);
    b = encode(State{});
    b[3] = std::byte{4};
    reseal(b);
    EXPECT_EQ(decode(b, s), PacketFault::kind);
    for (const std::size_t at : {53U, 55U, 59U}) {
        b = encode(State{});
        b[at] = std::byte{0x80};
        reseal(b);
        EXPECT_EQ(decode(b, s), PacketFault::reserved) << at;
    }
    auto command = encode(Command{});
    command[24] = std::byte{2};
    reseal(command);
    EXPECT_EQ(decode(command, c), PacketFault::reserved);
    for (const std::byte bad : {std::byte{7}, std::byte{0x80}, std::byte{0}}) {
        auto info = encode(an_info());
        info[13] = bad;  // a control character, not ASCII, text after the end
        reseal(info);
        EXPECT_EQ(decode(info, i), PacketFault::text);
    }
    auto info = encode(an_info());
    info[4] = std::byte{0};
    reseal(info);
    EXPECT_EQ(decode(info, i), PacketFault::version);
}

TEST(Versions, the_highest_common_version_is_used) {
    Info device;
    device.version_low = 2;
    device.version_high = 4;
    EXPECT_EQ(common_version({1, 3}, device), 3);
    EXPECT_EQ(common_version({3, 9}, device), 4);
    EXPECT_EQ(common_version({1, 1}, device), 0);
    EXPECT_EQ(common_version({5, 6}, device), 0);
}

TEST(Sequence, repeated_stale_and_lost_packets_are_counted_across_the_wrap) {
    for (const std::uint32_t first : {0U, 0x7FFFFFF0U, 0xFFFFFFFDU}) {
        SequenceGate gate;
        EXPECT_EQ(gate.check(1, first, 100), Order::taken);
        EXPECT_EQ(gate.check(1, first, 200), Order::repeated);
        EXPECT_EQ(gate.check(1, first + 4, 300), Order::taken);
        EXPECT_EQ(gate.check(1, first + 2, 400), Order::stale);
        EXPECT_EQ(gate.check(1, first - 1000, 400), Order::stale);
        EXPECT_EQ(gate.check(1, first + 5, 400), Order::taken);
        EXPECT_EQ(gate.counts().taken, 3U);
        EXPECT_EQ(gate.counts().repeated, 1U);
        EXPECT_EQ(gate.counts().stale, 2U);
        EXPECT_EQ(gate.counts().lost, 3U);
    }
}

TEST(Sequence, a_clock_that_does_not_advance_is_refused_and_may_wrap) {
    SequenceGate gate;
    EXPECT_EQ(gate.check(1, 1, 0xFFFFFF00U), Order::taken);
    EXPECT_EQ(gate.check(1, 2, 0xFFFFFF00U), Order::clock);
    EXPECT_EQ(gate.check(1, 3, 0xFFFFFE00U), Order::clock);
    EXPECT_EQ(gate.check(1, 4, 0x00000010U), Order::taken);
    EXPECT_EQ(gate.counts().clock, 2U);
}

TEST(Sequence, a_restarted_device_is_refused_until_reset) {
    SequenceGate gate;
    EXPECT_EQ(gate.check(1, 500, 10), Order::taken);
    EXPECT_EQ(gate.check(2, 501, 20), Order::restarted);
    EXPECT_EQ(gate.check(2, 502, 30), Order::restarted);
    gate.reset();
    EXPECT_EQ(gate.check(2, 0, 1), Order::taken);
}

class Board {
public:
    explicit Board(std::uint32_t start_us = 1000)
        : amplifier(7, {5000, 5000, 5000, 5000, 5000, 100}), now_us(start_us) {
        command.boot = 7;
        command.current_ma.fill(300);
    }
    bool send(bool enable, std::uint32_t after_us = 1000) {
        wait(after_us);
        command.enable = enable;
        ++command.sequence;
        ++command.heartbeat;
        return amplifier.receive(encode(command), now_us);
    }
    void wait(std::uint32_t us, std::uint16_t causes = 0) {
        now_us += us;
        amplifier.tick(now_us, causes);
    }
    [[nodiscard]] bool powerless() const {
        return std::all_of(amplifier.current_ma().begin(), amplifier.current_ma().end(),
                           [](std::int16_t ma) { return ma == 0; });
    }
    Amplifier amplifier;
    Command command;
    std::uint32_t now_us;
};

TEST(Amplifier, only_an_enable_edge_powers_it) {
    Board b;
    EXPECT_TRUE(b.send(true));  // up from the start: no edge
    EXPECT_TRUE(b.powerless());
    b.send(false);
    EXPECT_TRUE(b.powerless());
    b.send(true);
    EXPECT_EQ(b.amplifier.state(), AmplifierState::on);
    EXPECT_EQ(b.amplifier.current_ma()[0], 300);
    EXPECT_EQ(b.amplifier.current_ma()[5], 100);  // this motor's own limit
    EXPECT_EQ(b.amplifier.status(), status::kAmplifierOn);
    b.send(false);
    EXPECT_TRUE(b.powerless());
}

TEST(Amplifier, ten_milliseconds_of_silence_trip_it_until_a_new_edge_on_any_clock) {
    for (const std::uint32_t start : {1000U, 0xFFFFF000U}) {
        Board b(start);
        b.send(false);
        b.send(true);
        for (int i = 0; i < 20; ++i) b.send(true, 9000);
        EXPECT_EQ(b.amplifier.state(), AmplifierState::on);
        b.wait(9999);
        EXPECT_EQ(b.amplifier.state(), AmplifierState::on);
        b.wait(1);
        EXPECT_EQ(b.amplifier.state(), AmplifierState::tripped);
        EXPECT_EQ(b.amplifier.status(), status::kWatchdogTripped);
        for (int i = 0; i < 50; ++i) b.send(true);
        EXPECT_TRUE(b.powerless());
        b.send(false);
        b.send(true);
        EXPECT_EQ(b.amplifier.state(), AmplifierState::on);
    }
}

TEST(Amplifier, a_command_that_comes_after_the_watchdog_does_not_undo_it) {
    Board b;
    b.send(false);
    b.send(true);
    b.now_us += 50'000;  // without ticks meanwhile
    b.command.sequence += 1;
    b.command.heartbeat += 1;
    EXPECT_TRUE(b.amplifier.receive(encode(b.command), b.now_us));
    EXPECT_TRUE(b.powerless());
}

TEST(Amplifier, corrupt_repeated_stale_foreign_and_frozen_commands_count_as_silence) {
    const auto trips = [](auto&& spoil) {
        Board b;
        b.send(false);
        b.send(true);
        const Command last = b.command;
        for (int i = 0; i < 12; ++i) {
            b.wait(1000);
            ++b.command.sequence;
            ++b.command.heartbeat;
            Command c = b.command;
            c.current_ma.fill(4000);
            auto bytes = spoil(c, last);
            b.amplifier.receive(bytes, b.now_us);
            EXPECT_TRUE(b.powerless() || b.amplifier.current_ma()[0] == 300);
        }
        return b.amplifier.state() == AmplifierState::tripped && b.amplifier.refused() == 12;
    };
    EXPECT_TRUE(trips([](const Command& c, const Command&) {
        auto bytes = encode(c);
        bytes[13] ^= std::byte{8};
        return bytes;
    }));
    EXPECT_TRUE(trips([](const Command&, const Command& last) { return encode(last); }));
    EXPECT_TRUE(trips([](Command c, const Command& last) {
        c.sequence = last.sequence - 5;
        return encode(c);
    }));
    EXPECT_TRUE(trips([](Command c, const Command&) {
        c.boot = 8;
        return encode(c);
    }));
    Board b;
    b.send(false);
    b.send(true);
    for (int i = 0; i < 12; ++i) {
        b.send(true);
        --b.command.heartbeat;
    }
    EXPECT_EQ(b.amplifier.state(), AmplifierState::tripped);
}

TEST(Amplifier, a_fault_is_latched_until_its_cause_ends_and_enable_was_low) {
    for (const std::uint16_t cause : {status::kOverTemperature, status::kBrownOut, status::kSafetyOpen}) {
        Board b;
        b.send(false);
        b.send(true);
        b.wait(100, cause);
        EXPECT_TRUE(b.powerless());
        b.wait(100, cause);
        b.command.enable = false;
        ++b.command.sequence;
        b.amplifier.receive(encode(b.command), b.now_us);  // while the cause persists
        EXPECT_EQ(b.amplifier.status() & cause, cause);
        b.wait(100);
        b.send(true);
        EXPECT_TRUE(b.powerless());  // the edge came while the fault was latched
        EXPECT_EQ(b.amplifier.state(), AmplifierState::fault);
        b.send(false);
        EXPECT_EQ(b.amplifier.status(), 0);
        b.send(true);
        EXPECT_EQ(b.amplifier.state(), AmplifierState::on);
    }
}

}  // namespace
}  // namespace tact::phantom::hal_phantom_packets_test
