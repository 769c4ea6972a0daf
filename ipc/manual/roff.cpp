#include "ipc/manual/roff.hpp"

#include <cstdint>
#include <cstdio>

namespace tact::manual {
namespace {

// Decodes the code point at `at` and advances `at`; U+FFFD for invalid bytes.
std::uint32_t next_code_point(const std::string& text, std::size_t& at) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
    };
    const unsigned char lead = byte(at++);
    const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    if (more == 0) return lead < 0x80 ? lead : 0xFFFDU;
    std::uint32_t code = lead & (0x3FU >> static_cast<unsigned>(more));
    for (int i = 0; i < more; ++i, ++at) {
        if ((byte(at) & 0xC0U) != 0x80U) return 0xFFFDU;
        code = code << 6U | (byte(at) & 0x3FU);
    }
    return code;
}

std::string one(std::uint32_t code, bool line_begins) {
    switch (code) {
        case '\\':
            return "\\e";
        case '-':
            return "\\-";
        case '\'':
            return "\\(aq";
        case '"':
            return "\\(dq";
        case '`':
            return "\\(ga";
        case '^':
            return "\\(ha";
        case '~':
            return "\\(ti";
        case '|':  // a line may break after it: choices make long words
            return "|\\:";
        case '\t':
        case '\r':
            return " ";
        case '.':
            return line_begins ? "\\&." : ".";
        default:
            break;
    }
    if (code < 0x20 && code != '\n') return "";
    if (code < 0x7F) return {static_cast<char>(code)};
    char named[16];
    std::snprintf(named, sizeof named, "\\[u%04X]", code);
    return named;
}

}  // namespace

std::string roff(const std::string& text) {
    std::string out;
    bool line_begins = true;
    for (std::size_t at = 0; at < text.size();) {
        const std::uint32_t code = next_code_point(text, at);
        if (line_begins && code == ' ') continue;  // a space there would start a new line
        out += one(code, line_begins);
        line_begins = code == '\n';
    }
    return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

}  // namespace tact::manual
