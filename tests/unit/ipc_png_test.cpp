// PNG files: images read back unchanged, and invalid files are refused by name.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/image/png.hpp"

namespace tact::ipc_png_test {
namespace {

namespace fs = std::filesystem;

class Png : public ::testing::Test {
protected:
    Png() { fs::create_directories(folder_); }
    ~Png() override { fs::remove_all(folder_); }

    fs::path folder_ = fs::temp_directory_path() / ("tact-png-" + std::to_string(getpid()));
    fs::path path_ = folder_ / "picture.png";
};

std::vector<std::uint8_t> ramp(std::size_t count) {
    std::vector<std::uint8_t> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(255 - 7 * i);
    return bytes;
}

TEST_F(Png, image_of_each_format_reads_back_unchanged_and_leaves_no_other_file) {
    for (const PngFormat format : {PngFormat::grey, PngFormat::rgb, PngFormat::rgba}) {
        const auto pixels = ramp(std::size_t{3} * 2 * static_cast<std::size_t>(format));
        write_png(path_, 3, 2, pixels, format);
        PngReader reader(path_);
        EXPECT_EQ(reader.width_px(), 3U);
        EXPECT_EQ(reader.height_px(), 2U);
        EXPECT_EQ(reader.colour(), format != PngFormat::grey);
        EXPECT_EQ(reader.read(format), pixels);
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
    }
}

TEST_F(Png, invalid_or_truncated_file_is_a_reader_error) {
    EXPECT_THROW(PngReader(folder_ / "absent.png"), PngError);
    std::ofstream(path_) << "not an image";
    EXPECT_THROW(PngReader{path_}, PngError);
    write_png(path_, 64, 64, ramp(64 * 64), PngFormat::grey);
    fs::resize_file(path_, fs::file_size(path_) / 2);
    PngReader cut(path_);
    EXPECT_EQ(cut.width_px(), 64U);
    EXPECT_THROW(static_cast<void>(cut.read(PngFormat::grey)), PngError);
}

TEST_F(Png, unwritable_path_and_wrong_size_are_errors) {
    const auto pixels = ramp(12);
    EXPECT_THROW(write_png(folder_ / "none" / "a.png", 2, 2, pixels), StartupError);
    EXPECT_THROW(write_png(path_, 0, 2, {}), StartupError);
    EXPECT_THROW(write_png(path_, 3, 2, pixels), StartupError);
    EXPECT_FALSE(fs::exists(path_));
}

}  // namespace
}  // namespace tact::ipc_png_test
