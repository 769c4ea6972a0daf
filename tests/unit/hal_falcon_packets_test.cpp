// The Falcon's packets: wire format, round trips, and rejected parts of a stream.
#include "hal/falcon/packets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>
#include <vector>

namespace tact::falcon::hal_falcon_packets_test {
namespace {

template <class Bytes>
std::string text(const Bytes& bytes) {
    std::string s;
    for (const std::byte b : bytes) s += static_cast<char>(b);
    return s;
}

std::vector<std::byte> bytes(const std::string& s) {
    std::vector<std::byte> out;
    for (const char c : s) out.push_back(static_cast<std::byte>(c));
    return out;
}

TEST(FalconPackets, follow_the_public_protocol) {
    // 0x0123, -1, 0x7FFF: lowest digit first, each digit four bits plus 'A'.
    EXPECT_EQ(text(encode(Request{{0x0123, -1, 0x7FFF}, led::kRed, true})), "<DCBAPPPPPPPHJA>");
    EXPECT_EQ(text(encode(Request{})), "<AAAAAAAAAAAAAA>");
    EXPECT_EQ(text(encode(Request{{}, 0xFF, false})), "<AAAAAAAAAAAAOA>");
    Reply r;
    ASSERT_EQ(decode(bytes("<DCBAPPPPPPPHJA>"), r), PacketFault::none);
    EXPECT_EQ(r, (Reply{{0x0123, -1, 0x7FFF}, 9, 0}));
    std::vector<std::byte> homed = bytes("<AAAAAAAAAAAAAA>");
    homed[13] = std::byte{0x41 + 0x74};
    ASSERT_EQ(decode(homed, r), PacketFault::none);
    EXPECT_EQ(r, (Reply{{}, 4, kHomedAll}));
}

TEST(FalconPackets, round_trip_through_encode_and_decode) {
    EXPECT_TRUE(rc::check([](std::array<std::int16_t, 3> v, std::uint8_t bits) {
        const Request request{v, static_cast<std::uint8_t>(bits & led::kAll), (bits & 1U) != 0};
        Request request_again;
        RC_ASSERT(decode(encode(request), request_again) == PacketFault::none);
        RC_ASSERT(request == request_again);
        const Reply reply{v, static_cast<std::uint8_t>(bits & 0xFU),
                          static_cast<std::uint8_t>(bits >> 4U & kHomedAll)};
        Reply reply_again;
        RC_ASSERT(decode(encode(reply), reply_again) == PacketFault::none);
        RC_ASSERT(reply == reply_again);
    }));
}

TEST(FalconPackets, a_byte_out_of_range_is_refused_and_changes_nothing) {
    const auto good = encode(Reply{{100, -200, 300}, 5, 3});
    const Reply before{{7, 7, 7}, 7, 7};
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (int v = 0; v < 256; ++v) {
            auto bad = good;
            bad[i] = static_cast<std::byte>(v);
            Reply r = before;
            const PacketFault fault = decode(bad, r);
            const bool digit = i >= 1 && i <= 12, inside = v >= 'A' && v <= 'P';
            PacketFault expected = PacketFault::none;  // the meaning of byte 14 is unknown
            if ((i == 0 || i == 15) && bad != good) expected = PacketFault::frame;
            if (digit && !inside) expected = PacketFault::digit;
            if (i == 13 && (v < 'A' || v >= 'A' + 128)) expected = PacketFault::bits;
            EXPECT_EQ(fault, expected) << i << ": " << v;
            if (fault != PacketFault::none) {
                EXPECT_EQ(r, before);
            }
        }
    }
    Reply r = before;
    for (std::size_t n = 0; n < 40; ++n) {
        if (n != kPacketBytes) {
            EXPECT_EQ(decode(std::vector<std::byte>(n), r), PacketFault::frame);
        }
    }
    Request q;
    auto homed = encode(Reply{{}, 0, 1});
    EXPECT_EQ(decode(homed, q), PacketFault::bits);
}

class Stream : public testing::Test {
protected:
    // Returns the replies decoded from these bytes.
    std::vector<Reply> feed(const std::string& s) {
        std::vector<Reply> out;
        Reply r;
        for (const std::byte b : bytes(s)) {
            if (stream_.push(b, r)) out.push_back(r);
        }
        return out;
    }
    [[nodiscard]] std::uint64_t refused() const {
        std::uint64_t n = 0;
        for (const std::uint64_t r : stream_.counts().refused) n += r;
        return n;
    }
    ReplyStream stream_;
    const std::string one_ = text(encode(Reply{{1, 2, 3}, 0, 7})),
                      two_ = text(encode(Reply{{4, 5, 6}, 1, 7}));
};

TEST_F(Stream, finds_replies_in_any_fragmentation) {
    EXPECT_EQ(feed(one_ + two_).size(), 2U);
    EXPECT_TRUE(feed(one_.substr(0, 5)).empty());
    const auto rest = feed(one_.substr(5));
    ASSERT_EQ(rest.size(), 1U);
    EXPECT_EQ(rest[0], (Reply{{1, 2, 3}, 0, 7}));
    EXPECT_EQ(stream_.counts().good, 3U);
    EXPECT_EQ(refused() + stream_.counts().skipped, 0U);
}

TEST_F(Stream, a_short_packet_is_refused_and_the_next_one_is_found) {
    // Real devices send packets of fourteen bytes now and then.
    EXPECT_EQ(feed(one_.substr(0, 13) + ">" + two_).size(), 1U);
    EXPECT_EQ(refused(), 1U);
    EXPECT_EQ(feed(one_.substr(0, 9) + two_).size(), 1U);
    EXPECT_EQ(refused(), 2U);
    EXPECT_EQ(feed("AAA>" + two_).size(), 1U);
    EXPECT_EQ(stream_.counts().skipped, 4U);
}

TEST_F(Stream, a_packet_without_end_is_refused_and_the_next_one_is_found) {
    EXPECT_EQ(feed(one_.substr(0, 15) + two_).size(), 1U);
    EXPECT_EQ(feed(one_.substr(0, 15) + "A" + two_).size(), 1U);
    EXPECT_EQ(refused(), 2U);
}

TEST_F(Stream, noise_loses_only_the_packets_that_it_hits) {
    EXPECT_TRUE(rc::check([this](const std::vector<std::uint8_t>& noise) {
        ReplyStream s;
        Reply r;
        for (const std::uint8_t n : noise) s.push(static_cast<std::byte>(n), r);
        int good = 0;
        for (int i = 0; i < 3; ++i) {
            for (const std::byte b : bytes(one_)) good += s.push(b, r) ? 1 : 0;
        }
        RC_ASSERT(good >= 2);
        RC_ASSERT(r == (Reply{{1, 2, 3}, 0, 7}));
    }));
}

TEST_F(Stream, reset_discards_half_a_packet) {
    feed(one_.substr(0, 8));
    stream_.reset();
    EXPECT_TRUE(feed(one_.substr(8)).empty());
    EXPECT_EQ(feed(two_).size(), 1U);
}

}  // namespace
}  // namespace tact::falcon::hal_falcon_packets_test
