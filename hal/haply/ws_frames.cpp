#include "hal/haply/ws_frames.hpp"

#include <algorithm>
#include <array>

namespace tact::haply {

namespace {

constexpr std::string_view kKey = "dGhlIHNhbXBsZSBub25jZQ==", kAccept = "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=";
constexpr std::size_t kControlMax = 125;

std::uint8_t byte_of(char c) { return static_cast<std::uint8_t>(c); }

bool same_name(std::string_view a, std::string_view lower) {
    const auto low = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), lower.begin(), lower.end(),
                      [&](char x, char y) { return low(x) == y; });
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

}  // namespace

std::string handshake_request(std::string_view host, std::uint16_t port) {
    std::string request = "GET / HTTP/1.1\r\nHost: ";
    request.append(host).append(":").append(std::to_string(port));
    request.append("\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: ").append(kKey);
    return request.append("\r\nSec-WebSocket-Version: 13\r\n\r\n");
}

ReadResult check_handshake(std::string_view answer, std::size_t& used) {
    const std::size_t end = answer.substr(0, kHandshakeMax).find("\r\n\r\n");
    if (end == std::string_view::npos)
        return answer.size() >= kHandshakeMax ? ReadResult::broken : ReadResult::need_more;
    used = end + 4;
    std::string_view rest = answer.substr(0, end);
    if (!rest.starts_with("HTTP/1.1 101")) return ReadResult::broken;
    while (!rest.empty()) {
        const std::size_t line_end = rest.find("\r\n");
        const std::string_view line = rest.substr(0, line_end);
        rest.remove_prefix(line_end == std::string_view::npos ? rest.size() : line_end + 2);
        const std::size_t colon = line.find(':');
        if (colon != std::string_view::npos && same_name(line.substr(0, colon), "sec-websocket-accept"))
            return trimmed(line.substr(colon + 1)) == kAccept ? ReadResult::message : ReadResult::broken;
    }
    return ReadResult::broken;
}

void append_frame(std::string& out, Opcode opcode, std::string_view payload, std::uint32_t mask) {
    out.push_back(static_cast<char>(0x80U | static_cast<unsigned>(opcode)));
    const std::size_t n = payload.size();
    const auto push = [&](unsigned bytes) {
        for (unsigned i = bytes; i-- > 0;) out.push_back(static_cast<char>(n >> (8 * i) & 0xFF));
    };
    if (n < 126) {
        out.push_back(static_cast<char>(0x80U | n));
    } else if (n <= 0xFFFF) {
        out.push_back(static_cast<char>(0x80U | 126U));
        push(2);
    } else {
        out.push_back(static_cast<char>(0x80U | 127U));
        push(8);
    }
    std::array<char, 4> key{};
    for (unsigned i = 0; i < 4; ++i) key[i] = static_cast<char>(mask >> (8 * i) & 0xFF);
    out.append(key.data(), key.size());
    for (std::size_t i = 0; i < n; ++i) out.push_back(static_cast<char>(payload[i] ^ key[i % 4]));
}

ReadResult FrameReader::broken() {
    broken_ = true;
    return ReadResult::broken;
}

void FrameReader::clear() {
    buffer_.clear();
    joined_.clear();
    at_ = 0;
    joined_opcode_ = Opcode::continuation;
    broken_ = false;
}

bool FrameReader::feed(std::string_view bytes) {
    buffer_.erase(0, at_);
    at_ = 0;
    if (broken_ || buffer_.size() + bytes.size() > 2 * kMessageMax) {
        broken_ = true;
        return false;
    }
    buffer_.append(bytes);
    return true;
}

ReadResult FrameReader::next(Opcode& opcode, std::string& payload) {
    while (true) {
        if (broken_) return ReadResult::broken;
        const std::string_view rest = std::string_view(buffer_).substr(at_);
        if (rest.size() < 2) return ReadResult::need_more;
        const std::uint8_t first = byte_of(rest[0]), second = byte_of(rest[1]);
        // No extension was agreed, and a server does not mask.
        if ((first & 0x70U) != 0 || (second & 0x80U) != 0) return broken();
        const bool final = (first & 0x80U) != 0;
        const auto code = static_cast<Opcode>(first & 0x0FU);
        std::size_t header = 2;
        std::uint64_t size = second & 0x7FU;
        if (size >= 126) {
            const std::size_t bytes = size == 126 ? 2 : 8;
            header += bytes;
            if (rest.size() < header) return ReadResult::need_more;
            size = 0;
            for (std::size_t i = 0; i < bytes; ++i) size = size << 8U | byte_of(rest[2 + i]);
        }
        const bool control = (first & 0x08U) != 0;
        if (control && (!final || size > kControlMax)) return broken();
        if (size > kMessageMax || joined_.size() + size > kMessageMax) return broken();
        if (rest.size() < header + size) return ReadResult::need_more;
        const std::string_view data = rest.substr(header, static_cast<std::size_t>(size));
        at_ += header + static_cast<std::size_t>(size);
        if (control) {
            if (code != Opcode::close && code != Opcode::ping && code != Opcode::pong) return broken();
            opcode = code;
            payload.assign(data);
            return ReadResult::message;
        }
        const bool begins = code == Opcode::text || code == Opcode::binary;
        const bool inside = joined_opcode_ != Opcode::continuation;
        if ((!begins && code != Opcode::continuation) || begins == inside) return broken();
        if (begins) joined_opcode_ = code;
        joined_.append(data);
        if (!final) continue;
        opcode = joined_opcode_;
        payload.swap(joined_);
        joined_.clear();
        joined_opcode_ = Opcode::continuation;
        return ReadResult::message;
    }
}

}  // namespace tact::haply
