#include "ipc/scene/file/packing.hpp"

#include <zlib.h>

namespace tact {

std::uint32_t crc_of(const void* data, std::size_t size, std::uint32_t before) {
    return static_cast<std::uint32_t>(crc32_z(before, static_cast<const Bytef*>(data), size));
}

std::size_t pack(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& to) {
    const std::size_t at = to.size();
    uLongf size = compressBound(bytes.size());
    to.resize(at + size);
    compress2(to.data() + at, &size, bytes.data(), bytes.size(), Z_BEST_SPEED);
    to.resize(at + size);
    return size;
}

std::uint64_t packed_most(std::uint64_t bytes) { return compressBound(bytes); }

bool unpack(std::span<const std::uint8_t> packed, std::span<std::uint8_t> to) {
    uLongf size = to.size();
    return uncompress(to.data(), &size, packed.data(), packed.size()) == Z_OK && size == to.size();
}

}  // namespace tact
