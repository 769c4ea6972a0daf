#include "hal/phantom/packets.hpp"

#include <algorithm>
#include <concepts>
#include <type_traits>

namespace tact::phantom {

namespace {

enum class Kind : std::uint8_t { state = 1, command = 2, query = 3, info = 4 };
constexpr std::uint8_t kFrozen = 0;  // the version byte of query and info

// CRC-32 of IEEE 802.3: reflected 0xEDB88320, start and end inverted. It detects every error of up to 3 bits,
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

void head(std::span<std::byte> bytes, std::uint8_t version, Kind kind) noexcept {
    write(bytes, 0, kMagic);
    write(bytes, 2, version);
    write(bytes, 3, static_cast<std::uint8_t>(kind));
}

void seal(std::span<std::byte> bytes) noexcept {
    write(bytes, bytes.size() - 4, crc32(bytes.first(bytes.size() - 4)));
}

// Checks the CRC before version and kind, so that a bit error there does not count as another version.
PacketFault check(std::span<const std::byte> bytes, std::size_t size, std::uint8_t version,
                  Kind kind) noexcept {
    if (bytes.size() != size) return PacketFault::size;
    if (read<std::uint16_t>(bytes, 0) != kMagic) return PacketFault::magic;
    if (read<std::uint32_t>(bytes, size - 4) != crc32(bytes.first(size - 4))) return PacketFault::checksum;
    if (read<std::uint8_t>(bytes, 2) != version) return PacketFault::version;
    if (read<std::uint8_t>(bytes, 3) != static_cast<std::uint8_t>(kind)) return PacketFault::kind;
    return PacketFault::none;
}

// Printable up to the first zero, zeros after it.
bool text(const std::array<char, 16>& chars) noexcept {
    bool ended = false;
    for (const char c : chars) {
        if (c == '\0') ended = true;
        if (ended ? c != '\0' : c < ' ' || c > '~') return false;
    }
    return true;
}

// Writer and Reader handle the fields of a packet at their offsets, and the reserved bytes between them.
class Writer {
public:
    explicit Writer(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

    template <class T>
    void operator()(std::size_t at, const T& value) noexcept {
        write(bytes_, at, value);
    }
    template <class T, std::size_t N>
    void operator()(std::size_t at, const std::array<T, N>& values) noexcept {
        for (std::size_t i = 0; i < N; ++i) write(bytes_, at + i * sizeof(T), values[i]);
    }
    void operator()(std::size_t at, bool value) noexcept {
        write(bytes_, at, static_cast<std::uint16_t>(value ? 1 : 0));
    }
    void reserved(std::size_t /*at*/, std::size_t /*size*/) noexcept {}  // already zero

private:
    std::span<std::byte> bytes_;
};

class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

    template <class T>
    void operator()(std::size_t at, T& value) noexcept {
        value = read<T>(bytes_, at);
    }
    template <class T, std::size_t N>
    void operator()(std::size_t at, std::array<T, N>& values) noexcept {
        for (std::size_t i = 0; i < N; ++i) values[i] = read<T>(bytes_, at + i * sizeof(T));
    }
    void operator()(std::size_t at, bool& value) noexcept {
        const auto flags = read<std::uint16_t>(bytes_, at);
        clean_ = clean_ && flags <= 1;
        value = flags == 1;
    }
    void reserved(std::size_t at, std::size_t size) noexcept {
        for (const std::byte b : bytes_.subspan(at, size)) clean_ = clean_ && b == std::byte{0};
    }
    [[nodiscard]] bool clean() const noexcept { return clean_; }  // all reserved bytes are zero

private:
    std::span<const std::byte> bytes_;
    bool clean_ = true;
};

// The tables of PROTOCOL.md. `Of` is the packet type, const when writing.
template <class Way, class Of>
requires std::same_as<std::remove_const_t<Of>, State>
void fields(Way& way, Of& s) noexcept {
    way(4, s.sequence);
    way(8, s.time_us);
    way(12, s.command_seen);
    way(16, s.counts);
    way(40, s.current_ma);
    way(52, s.status);
    way(54, s.inputs);
    way(56, s.boot);
    way(58, s.commands_refused);
    way.reserved(59, 1);
}

template <class Way, class Of>
requires std::same_as<std::remove_const_t<Of>, Command>
void fields(Way& way, Of& c) noexcept {
    way(4, c.sequence);
    way(8, c.heartbeat);
    way(12, c.current_ma);
    way(24, c.enable);
    way(26, c.boot);
}

template <class Way, class Of>
requires std::same_as<std::remove_const_t<Of>, Query>
void fields(Way& way, Of& q) noexcept {
    way(4, q.version_low);
    way(5, q.version_high);
    way.reserved(6, 6);
}

template <class Way, class Of>
requires std::same_as<std::remove_const_t<Of>, Info>
void fields(Way& way, Of& i) noexcept {
    way(4, i.version_low);
    way(5, i.version_high);
    way(6, i.boot);
    way(8, i.rate_hz);
    way(10, i.watchdog_ms);
    way(12, i.serial);
    way(28, i.model);
    way(44, i.current_ma_max);
    way.reserved(56, 4);
}

// Constraints on the values.
PacketFault complaint(const State& s) noexcept {
    const bool reserved = (s.status & ~status::kAll) != 0 || (s.inputs & ~input::kAll) != 0;
    return reserved ? PacketFault::reserved : PacketFault::none;
}
PacketFault complaint(const Command& /*c*/) noexcept { return PacketFault::none; }
PacketFault complaint(const Query& q) noexcept {
    return q.version_low == 0 || q.version_low > q.version_high ? PacketFault::version : PacketFault::none;
}
PacketFault complaint(const Info& i) noexcept {
    if (i.version_low == 0 || i.version_low > i.version_high) return PacketFault::version;
    return text(i.serial) && text(i.model) ? PacketFault::none : PacketFault::text;
}

template <std::size_t N, class Packet>
std::array<std::byte, N> encoded(std::uint8_t version, Kind kind, const Packet& packet) noexcept {
    std::array<std::byte, N> out{};
    head(out, version, kind);
    Writer way(out);
    fields(way, packet);
    seal(out);
    return out;
}

template <std::size_t N, class Packet>
PacketFault decoded(std::span<const std::byte> bytes, std::uint8_t version, Kind kind, Packet& out) noexcept {
    if (const PacketFault f = check(bytes, N, version, kind); f != PacketFault::none) return f;
    Packet packet;
    Reader way(bytes);
    fields(way, packet);
    if (!way.clean()) return PacketFault::reserved;
    if (const PacketFault f = complaint(packet); f != PacketFault::none) return f;
    out = packet;
    return PacketFault::none;
}

}  // namespace

std::string_view text_of(const std::array<char, 16>& chars) noexcept {
    return {chars.data(),
            static_cast<std::size_t>(std::find(chars.begin(), chars.end(), '\0') - chars.begin())};
}

std::array<std::byte, kStateBytes> encode(const State& s) noexcept {
    return encoded<kStateBytes>(kVersion, Kind::state, s);
}
std::array<std::byte, kCommandBytes> encode(const Command& c) noexcept {
    return encoded<kCommandBytes>(kVersion, Kind::command, c);
}
std::array<std::byte, kQueryBytes> encode(const Query& q) noexcept {
    return encoded<kQueryBytes>(kFrozen, Kind::query, q);
}
std::array<std::byte, kInfoBytes> encode(const Info& i) noexcept {
    return encoded<kInfoBytes>(kFrozen, Kind::info, i);
}

PacketFault decode(std::span<const std::byte> bytes, State& out) noexcept {
    return decoded<kStateBytes>(bytes, kVersion, Kind::state, out);
}
PacketFault decode(std::span<const std::byte> bytes, Command& out) noexcept {
    return decoded<kCommandBytes>(bytes, kVersion, Kind::command, out);
}
PacketFault decode(std::span<const std::byte> bytes, Query& out) noexcept {
    return decoded<kQueryBytes>(bytes, kFrozen, Kind::query, out);
}
PacketFault decode(std::span<const std::byte> bytes, Info& out) noexcept {
    return decoded<kInfoBytes>(bytes, kFrozen, Kind::info, out);
}

std::uint8_t common_version(const Query& pc, const Info& device) noexcept {
    const std::uint8_t high = std::min(pc.version_high, device.version_high);
    return high >= pc.version_low && high >= device.version_low ? high : std::uint8_t{0};
}

}  // namespace tact::phantom
