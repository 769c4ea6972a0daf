// A picture in memory, and what curves need to be drawn on it: filled boxes, smooth lines, text.
//
// Units    pixels, x to the right, y down, the middle of the first pixel at (0.5, 0.5)
// Colour   8 bits per channel, sRGB, drawn over what is there
// Errors   Font and save_png throw StartupError; drawing never fails, what lies outside is cut off
// Thread   any, one object at a time
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tact::plot {

struct Colour {
    std::uint8_t r = 0, g = 0, b = 0;
};

struct Pixel {
    double x = 0.0, y = 0.0;
};

struct Box {
    int left = 0, top = 0, right = 0, bottom = 0;  // right and bottom are outside
    [[nodiscard]] int width() const { return right - left; }
    [[nodiscard]] int height() const { return bottom - top; }
};

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // rows from the top, four bytes each pixel
};

// A file, whole or not at all.
void save_png(const Image& image, const std::filesystem::path& path);

// Letters by FreeType, from a font file of the system.
class Font {
public:
    Font();  // $TACT_FONT, else the first sans-serif font that is found
    explicit Font(const std::filesystem::path& file);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    struct Glyph {
        int width = 0, height = 0;
        int left = 0, top = 0;  // of the bitmap from the pen; top is upward
        double advance = 0.0;
        std::vector<std::uint8_t> coverage;
    };
    // UTF-8; a letter that the font lacks is drawn as the font's box. size_px from 4 to 200.
    [[nodiscard]] std::vector<Glyph> glyphs(std::string_view text, int size_px) const;
    [[nodiscard]] double width(std::string_view text, int size_px) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The code points of a text; malformed bytes read as U+FFFD.
[[nodiscard]] std::vector<std::uint32_t> code_points(std::string_view utf8);

enum class Anchor : std::uint8_t { left, middle, right };

class Canvas {
public:
    Canvas(int width, int height, Colour paper);

    void fill(const Box& box, Colour colour, double opacity = 1.0);
    // One line through all points, as wide everywhere, drawn once: crossings of itself do not get darker.
    // dash_px 0: unbroken; else dashes of that length with gaps of the same. Cut at the box.
    void polyline(std::span<const Pixel> points, Colour colour, double width_px, const Box& cut,
                  double dash_px = 0.0);
    // y is the base line of the letters.
    void text(const Font& font, std::string_view words, Pixel at, int size_px, Colour colour,
              Anchor anchor = Anchor::left);

    // Another image as it is, its upper left pixel at (x, y); what lies outside is cut off.
    void paste(const Image& other, int x, int y);

    [[nodiscard]] const Image& image() const { return image_; }

private:
    void blend(int x, int y, Colour colour, double opacity);

    Image image_;
    std::vector<float> coverage_;  // of the line that is being drawn
};

}  // namespace tact::plot
