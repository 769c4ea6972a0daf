#include "hal/phantom/packets.hpp"

#include <algorithm>
#include <type_traits>

namespace tact::phantom {

namespace {

enum class Kind : std::uint8_t { state = 1, command = 2, query = 3, info = 4 };
constexpr std::uint8_t kFrozen = 0;  // the version byte of query and info

// CRC-32 of IEEE 802.3: reflected 0xEDB88320, start and end inverted. It finds every error of up to 3 bits,
// and every burst of up to 32, in packets this short.
constexpr std::array<std::uint32_t, 256> kCrc = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        table[i] = c;
    }
    return table;
}();

std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
    std::uint32_t c = 0xFFFFFFFFU;
    for (const std::byte b : bytes) c = kCrc[(c ^ static_cast<std::uint32_t>(b)) & 0xFFU] ^ (c >> 8U);
    return ~c;
}

template <class T>
T read(std::span<const std::byte> bytes, std::size_t at) noexcept {
    using U = std::make_unsigned_t<T>;
    U v = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        v = static_cast<U>(v | static_cast<U>(static_cast<U>(bytes[at + i]) << (8 * i)));
    }
    return static_cast<T>(v);
}

template <class T>
void write(std::span<std::byte> bytes, std::size_t at, T value) noexcept {
    const auto v = static_cast<std::make_unsigned_t<T>>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i)
        bytes[at + i] = static_cast<std::byte>((v >> (8 * i)) & 0xFFU);
}

template <class T, std::size_t N>
void write_all(std::span<std::byte> bytes, std::size_t at, const std::array<T, N>& values) noexcept {
    for (std::size_t i = 0; i < N; ++i) write(bytes, at + i * sizeof(T), values[i]);
}

template <class T, std::size_t N>
void read_all(std::span<const std::byte> bytes, std::size_t at, std::array<T, N>& values) noexcept {
    for (std::size_t i = 0; i < N; ++i) values[i] = read<T>(bytes, at + i * sizeof(T));
}

void head(std::span<std::byte> bytes, std::uint8_t version, Kind kind) noexcept {
    write(bytes, 0, kMagic);
    write(bytes, 2, version);
    write(bytes, 3, static_cast<std::uint8_t>(kind));
}

void seal(std::span<std::byte> bytes) noexcept {
    write(bytes, bytes.size() - 4, crc32(bytes.first(bytes.size() - 4)));
}

// The checksum comes before version and kind, so that a flipped bit there is not taken for another version.
PacketFault check(std::span<const std::byte> bytes, std::size_t size, std::uint8_t version,
                  Kind kind) noexcept {
    if (bytes.size() != size) return PacketFault::size;
    if (read<std::uint16_t>(bytes, 0) != kMagic) return PacketFault::magic;
    if (read<std::uint32_t>(bytes, size - 4) != crc32(bytes.first(size - 4))) return PacketFault::checksum;
    if (read<std::uint8_t>(bytes, 2) != version) return PacketFault::version;
    if (read<std::uint8_t>(bytes, 3) != static_cast<std::uint8_t>(kind)) return PacketFault::kind;
    return PacketFault::none;
}

bool zero(std::span<const std::byte> bytes) noexcept {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

// Printable up to the first zero, zeros from there on.
bool text(const std::array<char, 16>& chars) noexcept {
    bool ended = false;
    for (const char c : chars) {
        if (c == '\0') ended = true;
        if (ended ? c != '\0' : c < ' ' || c > '~') return false;
    }
    return true;
}

}  // namespace

std::array<std::byte, kStateBytes> encode(const State& s) noexcept {
    std::array<std::byte, kStateBytes> out{};
    head(out, kVersion, Kind::state);
    write(std::span(out), 4, s.sequence);
    write(std::span(out), 8, s.time_us);
    write(std::span(out), 12, s.command_seen);
    write_all(out, 16, s.counts);
    write_all(out, 40, s.current_ma);
    write(std::span(out), 52, s.status);
    write(std::span(out), 54, s.inputs);
    write(std::span(out), 56, s.boot);
    write(std::span(out), 58, s.commands_refused);
    seal(out);
    return out;
}

std::array<std::byte, kCommandBytes> encode(const Command& c) noexcept {
    std::array<std::byte, kCommandBytes> out{};
    head(out, kVersion, Kind::command);
    write(std::span(out), 4, c.sequence);
    write(std::span(out), 8, c.heartbeat);
    write_all(out, 12, c.current_ma);
    write(std::span(out), 24, static_cast<std::uint16_t>(c.enable ? 1 : 0));
    write(std::span(out), 26, c.boot);
    seal(out);
    return out;
}

std::array<std::byte, kQueryBytes> encode(const Query& q) noexcept {
    std::array<std::byte, kQueryBytes> out{};
    head(out, kFrozen, Kind::query);
    write(std::span(out), 4, q.version_low);
    write(std::span(out), 5, q.version_high);
    seal(out);
    return out;
}

std::array<std::byte, kInfoBytes> encode(const Info& i) noexcept {
    std::array<std::byte, kInfoBytes> out{};
    head(out, kFrozen, Kind::info);
    write(std::span(out), 4, i.version_low);
    write(std::span(out), 5, i.version_high);
    write(std::span(out), 6, i.boot);
    write(std::span(out), 8, i.rate_hz);
    write(std::span(out), 10, i.watchdog_ms);
    write_all(out, 12, i.serial);
    write_all(out, 28, i.model);
    write_all(out, 44, i.current_ma_max);
    seal(out);
    return out;
}

PacketFault decode(std::span<const std::byte> bytes, State& out) noexcept {
    if (const PacketFault f = check(bytes, kStateBytes, kVersion, Kind::state); f != PacketFault::none)
        return f;
    State s;
    s.sequence = read<std::uint32_t>(bytes, 4);
    s.time_us = read<std::uint32_t>(bytes, 8);
    s.command_seen = read<std::uint32_t>(bytes, 12);
    read_all(bytes, 16, s.counts);
    read_all(bytes, 40, s.current_ma);
    s.status = read<std::uint16_t>(bytes, 52);
    s.inputs = read<std::uint16_t>(bytes, 54);
    s.boot = read<std::uint16_t>(bytes, 56);
    s.commands_refused = read<std::uint8_t>(bytes, 58);
    const bool reserved = (s.status & ~status::kAll) != 0 || (s.inputs & ~input::kAll) != 0;
    if (reserved || !zero(bytes.subspan(59, 1))) return PacketFault::reserved;
    out = s;
    return PacketFault::none;
}

PacketFault decode(std::span<const std::byte> bytes, Command& out) noexcept {
    if (const PacketFault f = check(bytes, kCommandBytes, kVersion, Kind::command); f != PacketFault::none)
        return f;
    Command c;
    c.sequence = read<std::uint32_t>(bytes, 4);
    c.heartbeat = read<std::uint32_t>(bytes, 8);
    read_all(bytes, 12, c.current_ma);
    const auto flags = read<std::uint16_t>(bytes, 24);
    c.boot = read<std::uint16_t>(bytes, 26);
    if (flags > 1) return PacketFault::reserved;
    c.enable = flags == 1;
    out = c;
    return PacketFault::none;
}

PacketFault decode(std::span<const std::byte> bytes, Query& out) noexcept {
    if (const PacketFault f = check(bytes, kQueryBytes, kFrozen, Kind::query); f != PacketFault::none)
        return f;
    const Query q{read<std::uint8_t>(bytes, 4), read<std::uint8_t>(bytes, 5)};
    if (!zero(bytes.subspan(6, 6))) return PacketFault::reserved;
    if (q.version_low == 0 || q.version_low > q.version_high) return PacketFault::version;
    out = q;
    return PacketFault::none;
}

PacketFault decode(std::span<const std::byte> bytes, Info& out) noexcept {
    if (const PacketFault f = check(bytes, kInfoBytes, kFrozen, Kind::info); f != PacketFault::none) return f;
    Info i;
    i.version_low = read<std::uint8_t>(bytes, 4);
    i.version_high = read<std::uint8_t>(bytes, 5);
    i.boot = read<std::uint16_t>(bytes, 6);
    i.rate_hz = read<std::uint16_t>(bytes, 8);
    i.watchdog_ms = read<std::uint16_t>(bytes, 10);
    read_all(bytes, 12, i.serial);
    read_all(bytes, 28, i.model);
    read_all(bytes, 44, i.current_ma_max);
    if (!zero(bytes.subspan(56, 4))) return PacketFault::reserved;
    if (i.version_low == 0 || i.version_low > i.version_high) return PacketFault::version;
    if (!text(i.serial) || !text(i.model)) return PacketFault::text;
    out = i;
    return PacketFault::none;
}

std::uint8_t common_version(const Query& pc, const Info& device) noexcept {
    const std::uint8_t high = std::min(pc.version_high, device.version_high);
    return high >= pc.version_low && high >= device.version_low ? high : std::uint8_t{0};
}

Order SequenceGate::refused(std::uint16_t boot, std::uint32_t sequence) noexcept {
    if (!started_) return Order::taken;
    if (boot != boot_) {
        ++counts_.restarted;
        return Order::restarted;
    }
    const auto ahead = static_cast<std::int32_t>(sequence - newest_);
    if (ahead > 0) return Order::taken;
    ++(ahead == 0 ? counts_.repeated : counts_.stale);
    return ahead == 0 ? Order::repeated : Order::stale;
}

void SequenceGate::take(std::uint16_t boot, std::uint32_t sequence) noexcept {
    if (started_) counts_.lost += sequence - newest_ - 1U;
    started_ = true;
    boot_ = boot;
    newest_ = sequence;
    ++counts_.taken;
}

Order SequenceGate::check(std::uint16_t boot, std::uint32_t sequence) noexcept {
    const Order order = refused(boot, sequence);
    if (order == Order::taken) take(boot, sequence);
    return order;
}

Order SequenceGate::check(std::uint16_t boot, std::uint32_t sequence, std::uint32_t time_us) noexcept {
    const Order order = refused(boot, sequence);
    if (order != Order::taken) return order;
    if (timed_ && static_cast<std::int32_t>(time_us - newest_us_) <= 0) {
        ++counts_.clock;
        return Order::clock;
    }
    take(boot, sequence);
    timed_ = true;
    newest_us_ = time_us;
    return order;
}

}  // namespace tact::phantom
