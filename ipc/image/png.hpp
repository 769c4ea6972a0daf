// Reads and writes PNG files. Rows from the top, 8 bits per channel.
//
// Input     untrusted: the image size is known before any allocation; the caller checks it, then reads
// Errors    reading: PngError with libpng's text; writing: StartupError, and the file is complete or absent
// Thread    any but the servo's: it waits for the disk
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace tact {

struct PngError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class PngFormat : std::uint8_t { grey = 1, rgb = 3, rgba = 4 };  // bytes per pixel

class PngReader {
public:
    explicit PngReader(const std::filesystem::path& path);
    // Of a file's content, which must outlive the reader.
    explicit PngReader(std::span<const std::uint8_t> content);
    ~PngReader();
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    [[nodiscard]] std::uint32_t width_px() const noexcept;
    [[nodiscard]] std::uint32_t height_px() const noexcept;
    [[nodiscard]] bool colour() const noexcept;  // true for colour channels or a palette
    // Call once; returns width times height pixels, converted to `format`.
    [[nodiscard]] std::vector<std::uint8_t> read(PngFormat format);

private:
    struct State;
    std::unique_ptr<State> state_;
};

// A file's content. `pixels`: width times height pixels of `format`. name: for messages.
[[nodiscard]] std::vector<std::uint8_t> png_bytes(std::uint32_t width_px, std::uint32_t height_px,
                                                  std::span<const std::uint8_t> pixels,
                                                  PngFormat format = PngFormat::rgb,
                                                  const std::string& name = "of a report");
// The folder must exist.
void write_png(const std::filesystem::path& path, std::uint32_t width_px, std::uint32_t height_px,
               std::span<const std::uint8_t> pixels, PngFormat format = PngFormat::rgb);

}  // namespace tact
