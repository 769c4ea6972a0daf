#include "prep/volume/raw_scan.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

std::size_t bytes_of(RawType type) {
    switch (type) {
        case RawType::i8:
        case RawType::u8:
            return 1;
        case RawType::i16:
        case RawType::u16:
            return 2;
        case RawType::f64:
            return 8;
        case RawType::i32:
        case RawType::u32:
        case RawType::f32:
            break;
    }
    return 4;
}

template <class T>
void to_floats(const char* from, bool swap, double slope, double intercept, std::span<float> out) {
    for (float& value : out) {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), from, sizeof(T));
        if (swap) std::reverse(raw.begin(), raw.end());
        value = static_cast<float>(slope * static_cast<double>(std::bit_cast<T>(raw)) + intercept);
        from += sizeof(T);
    }
}

void convert(RawType type, const char* from, bool swap, double slope, double intercept,
             std::span<float> out) {
    switch (type) {
        case RawType::i8:
            return to_floats<std::int8_t>(from, swap, slope, intercept, out);
        case RawType::u8:
            return to_floats<std::uint8_t>(from, swap, slope, intercept, out);
        case RawType::i16:
            return to_floats<std::int16_t>(from, swap, slope, intercept, out);
        case RawType::u16:
            return to_floats<std::uint16_t>(from, swap, slope, intercept, out);
        case RawType::i32:
            return to_floats<std::int32_t>(from, swap, slope, intercept, out);
        case RawType::u32:
            return to_floats<std::uint32_t>(from, swap, slope, intercept, out);
        case RawType::f32:
            return to_floats<float>(from, swap, slope, intercept, out);
        case RawType::f64:
            return to_floats<double>(from, swap, slope, intercept, out);
    }
}

// Unpacks exactly `size` bytes of a zlib or gzip stream.
std::vector<char> inflated(std::string_view packed, std::uint64_t size, const std::string& attempt) {
    const auto fail = [&](const std::string& why) {
        throw StartupError(attempt, why, "export the scan again; the file is damaged or truncated");
    };
    // Deflate compresses by a factor of at most 1032.
    if (size / 1100 > packed.size() + 1)
        fail("the header declares " + std::to_string(size) + " bytes, more than " +
             std::to_string(packed.size()) + " compressed bytes can hold");
    std::vector<char> out(static_cast<std::size_t>(size));
    z_stream z{};
    if (inflateInit2(&z, 15 + 32) != Z_OK) fail("zlib could not be initialized");
    struct End {
        z_stream* stream;
        ~End() { inflateEnd(stream); }
    } const end{&z};
    constexpr std::size_t kPiece = std::size_t{1} << 30;
    std::size_t in = 0, made = 0;
    int status = Z_OK;
    while (status == Z_OK && made < out.size()) {
        const std::size_t give = std::min(packed.size() - in, kPiece),
                          room = std::min(out.size() - made, kPiece);
        z.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data() + in));
        z.avail_in = static_cast<uInt>(give);
        z.next_out = reinterpret_cast<Bytef*>(out.data() + made);
        z.avail_out = static_cast<uInt>(room);
        status = inflate(&z, Z_NO_FLUSH);
        in += give - z.avail_in;
        made += room - z.avail_out;
        if (status == Z_OK && z.avail_in == give && z.avail_out == room) status = Z_BUF_ERROR;
    }
    if (made < out.size())
        fail("the compressed data hold " + std::to_string(made) + " bytes instead of " +
             std::to_string(size));
    return out;
}

}  // namespace

Scan raw_scan(RawHeader h, std::string_view bytes, std::shared_ptr<const void> owner,
              const std::string& attempt, float no_number) {
    const auto fail = [&](const std::string& why) {
        throw StartupError(attempt, why, "export the scan again; the file is damaged or truncated");
    };
    std::vector<std::uint32_t> order;
    Scan scan = scan_of(h.axes, attempt, order);
    if (!(std::isfinite(h.slope) && std::isfinite(h.intercept)) || h.slope == 0.0)
        fail("the slope " + std::to_string(h.slope) + " or intercept " + std::to_string(h.intercept) +
             " of the values is invalid");
    const std::uint64_t slice_bytes = std::uint64_t{scan.pixels()} * bytes_of(h.type);
    const std::uint64_t size = slice_bytes * order.size();
    if (size > kScanBytesMax)
        throw StartupError(
            attempt,
            "the scan has " + std::to_string(size) + " bytes, more than " + std::to_string(kScanBytesMax),
            "crop the scan, or bin it to larger voxels");
    if (h.packing == RawPacking::plain) {
        if (h.from_end && bytes.size() >= size) h.offset = bytes.size() - size;
        if (h.offset > bytes.size() || bytes.size() - h.offset < size)
            fail("the header declares " + std::to_string(size) + " bytes of voxels, but the file has " +
                 std::to_string(bytes.size() - std::min<std::uint64_t>(h.offset, bytes.size())));
        bytes = bytes.substr(static_cast<std::size_t>(h.offset), static_cast<std::size_t>(size));
    } else {
        if (h.offset > bytes.size()) fail("the data begin beyond the end of the file");
        auto unpacked = std::make_shared<std::vector<char>>(
            inflated(bytes.substr(static_cast<std::size_t>(h.offset)), size, attempt));
        bytes = std::string_view(unpacked->data(), unpacked->size());
        owner = std::move(unpacked);
    }
    if ((h.type == RawType::u8 || h.type == RawType::i8) && h.slope == 1.0 && h.intercept == 0.0)
        scan.values = ScanValues::grey;
    scan.label = std::move(h.label);
    scan.read = [bytes, owner = std::move(owner), order, slice_bytes, type = h.type,
                 swap = h.big_endian != (std::endian::native == std::endian::big), slope = h.slope,
                 intercept = h.intercept, no_number](std::uint32_t slice, std::span<float> pixels) {
        convert(type, bytes.data() + order.at(slice) * slice_bytes, swap, slope, intercept, pixels);
        for (float& value : pixels)
            if (!std::isfinite(value)) value = no_number;
    };
    return scan;
}

Scan read_raw_scan(const std::filesystem::path& path, const char* format, RawHeaderReader reader,
                   double unit_mm, float no_number) {
    const std::string attempt = "read scan " + path.string();
    auto input = std::make_shared<InputBytes>(path, kScanBytesMax + (1U << 20), kScanBytesMax + (1U << 20));
    RawHeader header = reader(input->view(), attempt, unit_mm);
    if (!header.data_file.empty()) {
        while (header.data_file.starts_with("./")) header.data_file.erase(0, 2);
        if (header.data_file.find('/') != std::string::npos ||
            header.data_file.find('%') != std::string::npos || header.data_file.starts_with("LIST"))
            throw StartupError(attempt,
                               "the voxels are in " + header.data_file +
                                   ", which is not a single file in the folder of the header",
                               "save the scan as one file");
        input =
            std::make_shared<InputBytes>(path.parent_path() / header.data_file, kScanBytesMax, kScanBytesMax);
        // A .gz file beside a header is already unpacked.
        const std::string_view b = input->view();
        const bool packed = b.size() > 2 && (b[0] == '\x1f' || b[0] == '\x78');
        if (header.packing == RawPacking::deflate && !packed) header.packing = RawPacking::plain;
    }
    const std::string_view bytes = input->view();
    Scan scan = raw_scan(std::move(header), bytes, std::move(input), attempt, no_number);
    scan.format = format;
    return scan;
}

}  // namespace tact
