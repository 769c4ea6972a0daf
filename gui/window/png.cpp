#include "gui/window/png.hpp"

#include <png.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "ipc/base/error.hpp"

namespace tact {

void write_png(const std::filesystem::path& path, const Image& image) {
    const std::string attempt = "writing the picture " + path.string();
    const std::string fix = "choose a folder that exists and can be written, with space left";
    std::filesystem::path partial = path;
    partial += "." + std::to_string(getpid()) + ".partial";
    const auto fail = [&](const std::string& why) {
        std::error_code ignored;
        std::filesystem::remove(partial, ignored);
        throw StartupError(attempt, why, fix);
    };
    std::FILE* const opened = std::fopen(partial.c_str(), "wb");
    if (opened == nullptr) fail(last_error());
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(opened, &std::fclose);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = image.width_px;
    header.height = image.height_px;
    header.format = PNG_FORMAT_RGB;
    if (png_image_write_to_stdio(&header, file.get(), 0, image.rgb.data(), 0, nullptr) == 0) {
        const std::string why = header.message;
        file.reset();
        fail(why);
    }
    if (std::fflush(file.get()) != 0 || fsync(fileno(file.get())) != 0) {
        const int error = errno;
        file.reset();
        fail(std::system_category().message(error));
    }
    file.reset();
    std::error_code error;
    std::filesystem::rename(partial, path, error);
    if (error) fail(error.message());
}

}  // namespace tact
