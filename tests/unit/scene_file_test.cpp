// The container: round trip, atomic writing, and corruption of every byte.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/scene_samples.hpp"

namespace tact::scene_file_test {
namespace {

namespace fs = std::filesystem;

class Folder : public ::testing::Test {
protected:
    Folder() {
        std::string name = (fs::temp_directory_path() / "tact-scene-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder() override { fs::remove_all(path_); }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path_), fs::directory_iterator{}));
    }
    fs::path path_;
};
using SceneFileOnDisk = Folder;

std::vector<std::byte> text(const char* s) {
    const auto* p = reinterpret_cast<const std::byte*>(s);
    return {p, p + std::strlen(s)};
}

TEST_F(SceneFileOnDisk, sections_read_back_unchanged) {
    SceneWriter out;
    out.add({'M', 'E', 'T', 'A'}, 3, 0, text("hello"));
    out.add({'B', 'O', 'D', 'Y'}, 1, 0, text("first"));
    out.add({'B', 'O', 'D', 'Y'}, 1, 1, text("second body"));
    out.add({'N', 'O', 'N', 'E'}, 1, 0, {});
    const fs::path path = path_ / "a.tact";
    out.write(path);
    EXPECT_EQ(entries(), 1U) << "the temporary file was left behind";
    const SceneFile file = SceneFile::open(path);
    EXPECT_EQ(file.count({'B', 'O', 'D', 'Y'}), 2U);
    EXPECT_EQ(file.count({'C', 'O', 'D', 'E'}), 0U);
    const auto second = file.section({'B', 'O', 'D', 'Y'}, 1, 1);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(second.data()), second.size()), "second body");
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(second.data()) % 64, 0U);
    EXPECT_TRUE(file.section({'N', 'O', 'N', 'E'}, 1).empty());
    const std::string absent = sample::error_of([&] { (void)file.section({'C', 'O', 'D', 'E'}, 1); });
    EXPECT_NE(absent.find("no section CODE 0"), std::string::npos) << absent;
    const std::string version = sample::error_of([&] { (void)file.section({'M', 'E', 'T', 'A'}, 1); });
    EXPECT_NE(version.find("version 3, this program reads 1"), std::string::npos) << version;
}

TEST_F(SceneFileOnDisk, checksum_identifies_the_content) {
    const fs::path path = path_ / "a.tact";
    sample::scene().write(path);
    const std::uint64_t first = SceneFile::open(path).checksum();
    sample::scene().write(path);
    EXPECT_EQ(SceneFile::open(path).checksum(), first);
    Structure moved = sample::structure();
    moved.x_m[0] *= 1.0001F;
    sample::scene(sample::meta(), moved).write(path);
    EXPECT_NE(SceneFile::open(path).checksum(), first);
}

TEST_F(SceneFileOnDisk, an_old_scene_survives_a_failed_write) {
    const fs::path path = path_ / "a.tact";
    sample::scene().write(path);
    const std::uint64_t before = SceneFile::open(path).checksum();
    const std::string error = sample::error_of([&] { sample::scene().write(path_ / "absent" / "b.tact"); });
    EXPECT_NE(error.find("No such file"), std::string::npos) << error;
    EXPECT_NE(sample::error_of([&] { sample::scene().write(path_); }).find("the path is a folder"),
              std::string::npos);
    EXPECT_EQ(SceneFile::open(path).checksum(), before);
    EXPECT_EQ(entries(), 1U);
}

TEST_F(SceneFileOnDisk, a_mapped_scene_stays_readable_while_it_is_replaced) {
    const fs::path path = path_ / "a.tact";
    sample::scene().write(path);
    SceneFile file = SceneFile::open(path);
    SceneMeta other = sample::meta();
    other.contour = 7.0;
    sample::scene(other).write(path);
    EXPECT_EQ(read_meta(file).contour, 1.5);
    file = SceneFile::open(path);
    EXPECT_EQ(read_meta(file).contour, 7.0);
}

TEST_F(SceneFileOnDisk, other_files_are_refused_with_a_fix) {
    const auto error = [&](const fs::path& path) {
        return sample::error_of([&] { (void)SceneFile::open(path); });
    };
    EXPECT_NE(error(path_ / "absent.tact").find("No such file"), std::string::npos);
    EXPECT_NE(error(path_).find("not a regular file"), std::string::npos);
    ASSERT_EQ(::mkfifo((path_ / "pipe").c_str(), 0600), 0);
    EXPECT_NE(error(path_ / "pipe").find("not a regular file"), std::string::npos);
    std::ofstream(path_ / "empty.tact").flush();
    EXPECT_NE(error(path_ / "empty.tact").find("0 bytes"), std::string::npos);
    std::ofstream(path_ / "text.tact") << std::string(500, 'x');
    const std::string text_error = error(path_ / "text.tact");
    EXPECT_NE(text_error.find("text.tact"), std::string::npos);
    EXPECT_NE(text_error.find("TACTSCN1"), std::string::npos);
    EXPECT_NE(text_error.find("fix:"), std::string::npos);
}

TEST(SceneFile, every_changed_bit_is_detected) {
    std::vector<std::byte> bytes = sample::scene().to_bytes();
    ASSERT_NO_THROW((void)SceneFile::from_bytes(bytes, "s"));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            bytes[i] ^= std::byte{1} << bit;
            const std::string error = sample::error_of([&] { (void)SceneFile::from_bytes(bytes, "s"); });
            ASSERT_FALSE(error.empty()) << "bit " << bit << " of byte " << i << " can change undetected";
            bytes[i] ^= std::byte{1} << bit;
        }
    }
}

TEST(SceneFile, every_truncation_and_every_extension_is_detected) {
    const std::vector<std::byte> bytes = sample::scene().to_bytes();
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        // A copy of exactly n bytes lets the sanitizers detect a read past the end.
        const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
        ASSERT_THROW((void)SceneFile::from_bytes(cut, "s"), StartupError) << n;
    }
    std::vector<std::byte> longer = bytes;
    longer.resize(longer.size() + 1);
    EXPECT_THROW((void)SceneFile::from_bytes(longer, "s"), StartupError);
}

TEST(SceneFile, sections_out_of_order_or_twice_are_refused) {
    SceneWriter twice;
    twice.add({'B', 'O', 'D', 'Y'}, 1, 0, text("x"));
    twice.add({'B', 'O', 'D', 'Y'}, 1, 0, text("y"));
    EXPECT_THROW((void)SceneFile::from_bytes(twice.to_bytes(), "s"), StartupError);
    SceneWriter gap;
    gap.add({'B', 'O', 'D', 'Y'}, 1, 1, text("x"));
    EXPECT_THROW((void)SceneFile::from_bytes(gap.to_bytes(), "s"), StartupError);
    EXPECT_THROW((void)SceneFile::from_bytes(SceneWriter().to_bytes(), "s"), StartupError);
}

}  // namespace
}  // namespace tact::scene_file_test
