#include "ipc/image/png.hpp"

#include <png.h>

#include <string>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

png_uint_32 code_of(PngFormat format) noexcept {
    return format == PngFormat::grey  ? PNG_FORMAT_GRAY
           : format == PngFormat::rgb ? PNG_FORMAT_RGB
                                      : PNG_FORMAT_RGBA;
}

}  // namespace

struct PngReader::State {
    png_image image{};
    State() { image.version = PNG_IMAGE_VERSION; }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { png_image_free(&image); }
};

PngReader::PngReader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
    if (png_image_begin_read_from_file(&state_->image, path.c_str()) == 0)
        throw PngError(state_->image.message);
}

PngReader::PngReader(std::span<const std::uint8_t> content) : state_(std::make_unique<State>()) {
    if (png_image_begin_read_from_memory(&state_->image, content.data(), content.size()) == 0)
        throw PngError(state_->image.message);
}

PngReader::~PngReader() = default;

std::uint32_t PngReader::width_px() const noexcept { return state_->image.width; }

std::uint32_t PngReader::height_px() const noexcept { return state_->image.height; }

bool PngReader::colour() const noexcept {
    return (state_->image.format & (PNG_FORMAT_FLAG_COLOR | PNG_FORMAT_FLAG_COLORMAP)) != 0;
}

std::vector<std::uint8_t> PngReader::read(PngFormat format) {
    state_->image.format = code_of(format);
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(state_->image));
    if (png_image_finish_read(&state_->image, nullptr, pixels.data(), 0, nullptr) == 0)
        throw PngError(state_->image.message);
    return pixels;
}

std::vector<std::uint8_t> png_bytes(std::uint32_t width_px, std::uint32_t height_px,
                                    std::span<const std::uint8_t> pixels, PngFormat format,
                                    const std::string& name) {
    const auto fail = [&name](const std::string& why) {
        throw StartupError("writing the image " + name, why, "set a size above zero");
    };
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width_px;
    image.height = height_px;
    image.format = code_of(format);
    const std::size_t bytes =
        static_cast<std::size_t>(width_px) * height_px * static_cast<std::size_t>(format);
    if (bytes == 0 || pixels.size() != bytes)
        fail(std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels of " +
             std::to_string(pixels.size()) + " bytes");
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::uint8_t> content(size);
    if (png_image_write_to_memory(&image, content.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        fail(image.message);
    content.resize(size);
    return content;
}

void write_png(const std::filesystem::path& path, std::uint32_t width_px, std::uint32_t height_px,
               std::span<const std::uint8_t> pixels, PngFormat format) {
    const std::vector<std::uint8_t> content = png_bytes(width_px, height_px, pixels, format, path.string());
    replace_file(path, std::string(content.begin(), content.end()));
}

}  // namespace tact
