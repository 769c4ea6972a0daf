#include "ipc/shm/region_header.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <span>

namespace tact {
namespace {

std::string hex(std::uint64_t value) {
    std::string s = "0x0000000000000000";
    for (std::size_t i = s.size() - 1; i > 1; --i, value >>= 4) s[i] = "0123456789abcdef"[value & 0xF];
    return s;
}

// Text from another process: bounded, and reduced to printable characters.
std::string shown(std::span<const char> text) {
    std::string s(text.begin(), std::find(text.begin(), text.end(), '\0'));
    for (char& c : s) {
        if (c < ' ' || c > '~') c = '?';
    }
    return s;
}

template <std::size_t N>
void put(char (&field)[N], const char* text) {
    std::memcpy(field, text, std::min(std::strlen(text), N - 1));
}

}  // namespace

RegionHeader make_region_header(const RegionIdentity& identity, std::uint64_t generation) {
    RegionHeader h{};
    h.magic = kRegionMagic;
    h.version = kRegionHeaderVersion;
    h.pid = static_cast<std::uint32_t>(getpid());
    h.layout_hash = identity.layout_hash;
    h.content_bytes = identity.bytes;
    h.generation = generation;
    put(h.name, identity.name);
    put(h.build, TACT_BUILD);
    return h;
}

std::string refuse_region_header(const RegionHeader& header, std::uint64_t ready, std::uint64_t file_bytes,
                                 const RegionIdentity& wanted) {
    const std::string region = std::string("region ") + wanted.name + ": ";
    const auto differ = [&region](const std::string& what, const std::string& found,
                                  const std::string& want) {
        return region + what + " is " + found + ", expected " + want;
    };
    const std::string builds = " (written by build " + shown(header.build) + ", read by build " + TACT_BUILD +
                               "; start both programs from the same build)";
    if (ready != kRegionReady) return differ("the ready mark", hex(ready), hex(kRegionReady));
    if (header.magic != kRegionMagic) return differ("the magic number", hex(header.magic), hex(kRegionMagic));
    if (header.version != kRegionHeaderVersion)
        return differ("the header version", std::to_string(header.version),
                      std::to_string(kRegionHeaderVersion)) +
               builds;
    RegionHeader probe{};
    put(probe.name, wanted.name);
    if (std::memcmp(header.name, probe.name, sizeof probe.name) != 0)
        return differ("the name", '"' + shown(header.name) + '"', '"' + shown(probe.name) + '"');
    if (header.layout_hash != wanted.layout_hash)
        return differ("the layout", hex(header.layout_hash), hex(wanted.layout_hash)) + builds;
    const std::uint64_t most = std::max(wanted.bytes, wanted.bytes_most);
    if (header.content_bytes < wanted.bytes || header.content_bytes > most)
        return differ("the content size", std::to_string(header.content_bytes),
                      std::to_string(wanted.bytes) +
                          (most > wanted.bytes ? " to " + std::to_string(most) : std::string())) +
               builds;
    if (file_bytes != kRegionHeaderBytes + header.content_bytes)
        return differ("the file size", std::to_string(file_bytes),
                      std::to_string(kRegionHeaderBytes + header.content_bytes));
    if (header.generation == 0) return differ("the generation", "0", "a non-zero number");
    return {};
}

}  // namespace tact
