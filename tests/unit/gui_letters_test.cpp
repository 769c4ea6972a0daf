// Names in all scripts: their letters are noted, fonts of the system are found for them, and the frame shows them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <random>

#include "gui/dashboard/drawn_texts.hpp"
#include "tests/unit/gui_dashboard_fixture.hpp"

namespace tact::gui_letters_test {
namespace {

const std::string kCyrillic = "Рибосома Ґанок Łódź";
const std::string kChinese = "核糖体结构";
const Instant kStart = instant_from_ns(1'000'000'000'000);

bool read_back(const std::string& text) {
    for (const DrawnText& t : drawn_texts(*ImGui::GetDrawData()))
        if (t.text.find(text) != std::string::npos) return true;
    return false;
}

FontData file_bytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool system_has(const std::string& utf8) {
    LetterSet letters;
    letters.note(utf8);
    std::size_t found = 0;
    for (const LetterFont& font : find_letter_fonts(letters.letters())) found += font.letters.size();
    return found == letters.letters().size();
}

// The environment of a test, restored at its end.
class FontsOff {
public:
    FontsOff() : file_(std::filesystem::temp_directory_path() / "tact_no_fonts.conf") {
        std::ofstream(file_) << "<?xml version=\"1.0\"?><fontconfig></fontconfig>\n";
        setenv("FONTCONFIG_FILE", file_.c_str(), 1);
    }
    ~FontsOff() {
        unsetenv("FONTCONFIG_FILE");
        std::filesystem::remove(file_);
    }
    FontsOff(const FontsOff&) = delete;
    FontsOff& operator=(const FontsOff&) = delete;

private:
    std::filesystem::path file_;
};

TEST(LetterSet, notes_each_letter_outside_of_the_text_font_once) {
    LetterSet set;
    set.note("plain ASCII of more than eight bytes, µ Å é Ω Ж – ≥");
    EXPECT_TRUE(set.letters().empty());
    set.note("12345678核sometext体核");
    ASSERT_EQ(set.letters().size(), 2U);
    EXPECT_EQ(set.letters()[0], 0x6838);
    EXPECT_EQ(set.letters()[1], 0x4F53);
    set.note("ệ");  // Vietnamese
    EXPECT_EQ(set.letters().size(), 3U);
}

TEST(LetterSet, skips_invalid_utf8) {
    for (const std::string bytes :
         {"\xE6\xA0", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF8\x88\x80\x80\x80", "\xF4\x90\x80\x80",
          "\x80\x80\xBF", "\xFF\xFE", "\xF0\x9F\x98\x80"}) {
        LetterSet set;
        set.note(bytes);
        set.note("1234567" + bytes);
        EXPECT_TRUE(set.letters().empty()) << set.letters()[0];
    }
    LetterSet set;
    set.note("\xE6\xA0核\xE6");  // a cut letter does not swallow the next one
    ASSERT_EQ(set.letters().size(), 1U);
    EXPECT_EQ(set.letters()[0], 0x6838);
}

TEST(LetterSet, is_bounded_for_any_bytes) {
    std::mt19937 random(7);
    LetterSet set;
    std::string bytes(1 << 20, ' ');
    for (char& c : bytes) c = static_cast<char>(random());
    set.note(bytes);
    for (unsigned c = 0x3400; c < 0x9FFF; ++c) {
        const char letter[] = {static_cast<char>(0xE0U | (c >> 12U)),
                               static_cast<char>(0x80U | ((c >> 6U) & 0x3FU)),
                               static_cast<char>(0x80U | (c & 0x3FU)), 0};
        set.note(letter);
    }
    EXPECT_EQ(set.letters().size(), LetterSet::kMost);
    EXPECT_GT(set.refused(), 20'000U);
    for (const ImWchar c : set.letters()) EXPECT_TRUE(c >= 0xA0 && (c < 0xD800 || c > 0xDFFF)) << c;
}

TEST(LetterFonts, of_damaged_files_are_refused) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    if (d.theme.font_file.empty()) GTEST_SKIP() << "no text font (fonts-dejavu-core)";
    const FontData whole = file_bytes(d.theme.font_file);
    ASSERT_GT(whole.size(), 10'000U);
    EXPECT_NEAR(font_line_per_em(whole, 0).value_or(0.0F), 1.17F, 0.02F);
    EXPECT_FALSE(font_line_per_em(whole, 1));
    EXPECT_FALSE(font_line_per_em(whole, -1));
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += bytes < 600 ? 1 : 4099)
        EXPECT_FALSE(font_line_per_em({whole.data(), bytes}, 0)) << bytes;
    FontData far = whole;  // a table beyond the end
    far[12 + 8] = 0x7F;
    EXPECT_FALSE(font_line_per_em(far, 0));
}

TEST(LetterFonts, are_not_needed_for_cyrillic_and_the_latin_of_europe) {
    const FontsOff off;
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    if (d.theme.font_file.empty()) GTEST_SKIP() << "no text font (fonts-dejavu-core)";
    d.state.scene.loaded = true;
    d.state.scene.title = kCyrillic;
    d.frame();
    EXPECT_FALSE(d.find_letters(kStart));
    EXPECT_TRUE(read_back(kCyrillic));
}

TEST(LetterFonts, are_found_for_a_chinese_title) {
    if (!system_has(kChinese)) GTEST_SKIP() << "no font with Chinese letters (fonts-wqy-microhei)";
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    d.state.scene.loaded = true;
    d.state.scene.title = kChinese + " 1080";
    d.frame();
    EXPECT_FALSE(read_back(kChinese));
    ASSERT_TRUE(d.find_letters(kStart));
    EXPECT_TRUE(d.theme.missing.empty());
    d.frame();
    EXPECT_TRUE(read_back(d.state.scene.title));
    for (const ImFont* const font : {d.theme.text, d.theme.small, d.theme.bold, d.theme.large}) {
        const ImFontGlyph* const glyph = font->FindGlyphNoFallback(0x6838);
        ASSERT_NE(glyph, nullptr);
        const float em = font->FontSize / 1.17F;  // Chinese letters are as wide as the em
        EXPECT_NEAR(glyph->AdvanceX, em, 0.15F * em + 1.0F);
        EXPECT_NEAR(glyph->X1 - glyph->X0, 0.9F * em, 0.25F * em);
        EXPECT_GT(glyph->Y0, -0.1F * font->FontSize);  // within the line
        EXPECT_LT(glyph->Y1, 1.1F * font->FontSize);
    }
}

TEST(LetterFonts, are_looked_for_once_for_each_new_set_and_at_most_twice_a_second) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    letters_on_screen().note(kChinese);
    EXPECT_TRUE(d.find_letters(kStart));
    EXPECT_FALSE(d.find_letters(kStart + std::chrono::seconds(5)));
    letters_on_screen().note("構");
    EXPECT_TRUE(d.find_letters(kStart + std::chrono::seconds(6)));
    letters_on_screen().note("造");
    EXPECT_FALSE(d.find_letters(kStart + std::chrono::milliseconds(6400)));
    EXPECT_TRUE(d.find_letters(kStart + std::chrono::milliseconds(6600)));
}

TEST(LetterFonts, are_looked_for_without_delaying_a_frame) {
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    std::promise<void> let_go;
    d.theme.find = [go = let_go.get_future().share()](std::vector<ImWchar> wanted, std::vector<LetterFont>) {
        go.wait();  // a cold cache
        EXPECT_EQ(wanted.size(), 5U);
        return std::vector<LetterFont>{};
    };
    letters_on_screen().note(kChinese);
    // A call that waited for the search would never return.
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(follow_letters(d.theme, kStart + std::chrono::milliseconds(100 * i)));
    letters_on_screen().note("造");  // during the search: for the next one
    let_go.set_value();
    d.theme.finding.wait();
    EXPECT_TRUE(follow_letters(d.theme, kStart + std::chrono::seconds(20)));
    EXPECT_EQ(d.theme.letters, 5U);
    EXPECT_LE(d.theme.missing.size(), 5U);
    d.theme.find = [](std::vector<ImWchar> wanted, std::vector<LetterFont>) {
        EXPECT_EQ(wanted.size(), 6U);
        return std::vector<LetterFont>{};
    };
    EXPECT_TRUE(d.find_letters(kStart + std::chrono::seconds(21)));
}

TEST(LetterFonts, that_are_missing_leave_a_substitute_and_name_a_package) {
    const FontsOff off;
    test::TestDashboard d(1280.0F, 720.0F, 1.0F);
    if (d.theme.font_file.empty()) GTEST_SKIP() << "no text font (fonts-dejavu-core)";
    d.state.scene.loaded = true;
    d.state.scene.title = "a" + kChinese + "b";
    d.frame();
    ASSERT_TRUE(d.find_letters(kStart));
    EXPECT_EQ(d.theme.missing.size(), 5U);
    d.frame();
    EXPECT_TRUE(read_back("a�����b"));
    EXPECT_EQ(
        missing_letters_text(d.theme.missing),
        "no font has the letter U+6838 and 4 more of the names shown: install the package fonts-noto-cjk "
        "(Chinese, Japanese, Korean)");
    EXPECT_EQ(
        missing_letters_text(std::vector<ImWchar>{0x0E01}),
        "no font has the letter U+0E01 of the names shown: install the package fonts-noto-core (most other "
        "scripts)");
    EXPECT_EQ(missing_letters_text({}), "");
}

TEST(LetterFonts, survive_hostile_names_at_every_size) {
    std::mt19937 random(11);
    for (const float scale : {0.5F, 1.0F, 3.0F, 6.0F}) {
        test::TestDashboard d(1280.0F, 720.0F, scale);
        d.state.scene.loaded = true;
        for (unsigned c = 0x4E00; c < 0x5800; ++c)
            letters_on_screen().note(std::string{static_cast<char>(0xE0U | (c >> 12U)),
                                                 static_cast<char>(0x80U | ((c >> 6U) & 0x3FU)),
                                                 static_cast<char>(0x80U | (c & 0x3FU))});
        d.state.scene.title.assign(400, '\xE6');
        for (char& c : d.state.scene.title) c = static_cast<char>(random() | 0x80U);
        d.frame();
        d.find_letters(kStart);
        d.frame();
        EXPECT_LE(ImGui::GetIO().Fonts->TexWidth, 8192);
        EXPECT_LE(ImGui::GetIO().Fonts->TexHeight, scale > 3.0F ? 16384 : 8192) << scale;
    }
}

}  // namespace
}  // namespace tact::gui_letters_test
