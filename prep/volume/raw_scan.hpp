// Scans as a header and one block of numbers, plain or compressed: NRRD, MetaImage and NIfTI files.
//
// Memory    plain numbers are memory-mapped; compressed ones are unpacked completely, at most kScanBytesMax. The size
//           declared by the header is compared with the bytes in the file before memory is allocated.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "prep/input/input_bytes.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

inline constexpr std::uint64_t kScanBytesMax = std::uint64_t{4} << 30;

enum class RawType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class RawPacking : std::uint8_t { plain, deflate };  // zlib or gzip, detected

struct RawHeader {
    ScanAxes axes;
    RawType type = RawType::i16;
    bool big_endian = false;
    RawPacking packing = RawPacking::plain;
    std::uint64_t offset = 0;  // of the numbers in their file
    bool from_end = false;     // the numbers are the last bytes of the file
    double slope = 1.0, intercept = 0.0;
    std::string data_file;  // in the header's folder; empty: the same file
    std::vector<ScanLabel> label;
};

// Parse a header alone; for tests and fuzzing. Throw StartupError or return a usable header. `unit_mm`: unit of length
// if the file states none.
RawHeader nrrd_header(std::string_view bytes, const std::string& attempt, double unit_mm);
RawHeader meta_image_header(std::string_view bytes, const std::string& attempt, double unit_mm);
RawHeader nifti_header(std::string_view bytes, const std::string& attempt, double unit_mm);

using RawHeaderReader = RawHeader (*)(std::string_view, const std::string&, double);
// no_number: replaces numbers that are not finite; by default the value of air.
Scan read_raw_scan(const std::filesystem::path& path, const char* format, RawHeaderReader reader,
                   double unit_mm, float no_number = -1024.0F);
// The voxels of a scan whose header is known; `owner` keeps `bytes` alive.
Scan raw_scan(RawHeader header, std::string_view bytes, std::shared_ptr<const void> owner,
              const std::string& attempt, float no_number = -1024.0F);

}  // namespace tact
