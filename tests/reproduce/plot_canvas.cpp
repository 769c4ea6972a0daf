// Lines are drawn by their distance: a pixel's coverage is 1 inside the line, 0 outside, and falls over one
// pixel around the edge; the largest over all segments counts. Slow next to a scan converter, and plain; a
// plot of a thousand columns takes a few milliseconds.
#include "tests/reproduce/plot_canvas.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "ipc/base/error.hpp"

namespace tact::plot {

void save_png(const Image& image, const std::filesystem::path& path) {
    const auto fail = [&path](const std::string& why) {
        throw StartupError("writing the picture " + path.string(), why,
                           "free some space, fix the permissions, or give another path");
    };
    if (image.width <= 0 || image.height <= 0 ||
        image.rgba.size() !=
            4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        fail("it has no size");
    std::error_code failed;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failed);
    const std::string temporary = path.string() + "." + std::to_string(getpid());
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGBA;
    const bool ok = png_image_write_to_file(&png, temporary.c_str(), 0, image.rgba.data(), 0, nullptr) != 0;
    if (ok && std::rename(temporary.c_str(), path.c_str()) == 0) return;
    const std::string why = ok ? std::strerror(errno) : png.message;
    unlink(temporary.c_str());
    fail(why);
}

namespace {

constexpr const char* kFonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",  // fonts-dejavu-core
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/truetype/freefont/FreeSans.ttf",
};

std::filesystem::path find_font() {
    const char* const chosen = std::getenv("TACT_FONT");
    if (chosen != nullptr && chosen[0] != '\0') return chosen;
    for (const char* const file : kFonts)
        if (access(file, R_OK) == 0) return file;
    throw StartupError("looking for a font to label plots", "none of the usual ones is installed",
                       "apt-get install fonts-dejavu-core, or set TACT_FONT to a .ttf file");
}

}  // namespace

std::vector<std::uint32_t> code_points(std::string_view utf8) {
    std::vector<std::uint32_t> points;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i++]);
        const int more = lead < 0x80U          ? 0
                         : (lead >> 5U) == 6U  ? 1
                         : (lead >> 4U) == 14U ? 2
                         : (lead >> 3U) == 30U ? 3
                                               : -1;
        std::uint32_t code = more == 0   ? lead
                             : more == 1 ? lead & 0x1FU
                             : more == 2 ? lead & 0x0FU
                                         : lead & 0x07U;
        bool good = more >= 0;
        for (int k = 0; k < more && good; ++k) {
            good = i < utf8.size() && (static_cast<unsigned char>(utf8[i]) >> 6U) == 2U;
            if (good) code = (code << 6U) | (static_cast<unsigned char>(utf8[i++]) & 0x3FU);
        }
        points.push_back(good ? code : 0xFFFDU);
    }
    return points;
}

struct Font::State {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_FreeType(library);
    }
};

Font::Font() : Font(find_font()) {}

Font::Font(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
    const bool ok = FT_Init_FreeType(&state_->library) == 0 &&
                    FT_New_Face(state_->library, file.c_str(), 0, &state_->face) == 0;
    if (!ok)
        throw StartupError("reading the font " + file.string(), "it is no font that FreeType can read",
                           "apt-get install fonts-dejavu-core, or set TACT_FONT to a .ttf file");
}

Font::~Font() = default;

std::vector<Font::Glyph> Font::glyphs(std::string_view text, int size_px) const {
    std::vector<Glyph> all;
    const FT_Face face = state_->face;
    if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(std::clamp(size_px, 4, 200))) != 0) return all;
    for (const std::uint32_t code : code_points(text)) {
        if (FT_Load_Char(face, code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
        const FT_GlyphSlot slot = face->glyph;
        const FT_Bitmap& from = slot->bitmap;
        Glyph g{.width = static_cast<int>(from.width),
                .height = static_cast<int>(from.rows),
                .left = slot->bitmap_left,
                .top = slot->bitmap_top,
                .advance = static_cast<double>(slot->advance.x) / 64.0,
                .coverage = {}};
        if (from.pixel_mode != FT_PIXEL_MODE_GRAY) g.width = g.height = 0;  // a space, or a bitmap font
        for (int y = 0; y < g.height; ++y) {
            const std::uint8_t* const row = from.buffer + static_cast<std::ptrdiff_t>(y) * from.pitch;
            g.coverage.insert(g.coverage.end(), row, row + g.width);
        }
        all.push_back(std::move(g));
    }
    return all;
}

double Font::width(std::string_view text, int size_px) const {
    double sum = 0.0;
    for (const Glyph& g : glyphs(text, size_px)) sum += g.advance;
    return sum;
}

Canvas::Canvas(int width, int height, Colour paper) {
    image_.width = std::clamp(width, 1, 16384);
    image_.height = std::clamp(height, 1, 16384);
    const auto pixels = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
    image_.rgba.reserve(4 * pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        image_.rgba.insert(image_.rgba.end(), {paper.r, paper.g, paper.b, std::uint8_t{255}});
    coverage_.assign(pixels, 0.0F);
}

void Canvas::blend(int x, int y, Colour colour, double opacity) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    std::uint8_t* const p =
        &image_.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                          static_cast<std::size_t>(x))];
    const auto mix = [opacity](std::uint8_t& under, std::uint8_t over) {
        under = static_cast<std::uint8_t>(
            std::lround(std::lerp(static_cast<double>(under), static_cast<double>(over), opacity)));
    };
    mix(p[0], colour.r);
    mix(p[1], colour.g);
    mix(p[2], colour.b);
}

void Canvas::fill(const Box& box, Colour colour, double opacity) {
    for (int y = std::max(box.top, 0); y < std::min(box.bottom, image_.height); ++y)
        for (int x = std::max(box.left, 0); x < std::min(box.right, image_.width); ++x)
            blend(x, y, colour, opacity);
}

void Canvas::paste(const Image& other, int x, int y) {
    for (int j = 0; j < other.height; ++j)
        for (int i = 0; i < other.width; ++i) {
            const std::uint8_t* const from =
                &other.rgba[4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(other.width) +
                                 static_cast<std::size_t>(i))];
            blend(x + i, y + j, {from[0], from[1], from[2]}, 1.0);
        }
}

void Canvas::polyline(std::span<const Pixel> points, Colour colour, double width_px, const Box& cut,
                      double dash_px) {
    const double half = width_px / 2.0;
    const Box in{std::max(cut.left, 0), std::max(cut.top, 0), std::min(cut.right, image_.width),
                 std::min(cut.bottom, image_.height)};
    const auto reach = [&](double low, double high, int from, int to) {
        const int a = static_cast<int>(std::floor(std::clamp(low - half - 1.0, -1e6, 1e6)));
        const int b = static_cast<int>(std::ceil(std::clamp(high + half + 1.0, -1e6, 1e6)));
        return std::pair{std::max(a, from), std::min(b, to)};
    };
    double run_px = 0.0;
    Box used{in.right, in.bottom, in.left, in.top};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Pixel a = points[i], b = points[i + 1];
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double length = std::hypot(dx, dy);
        if (!std::isfinite(length)) continue;
        const auto [left, right] = reach(std::min(a.x, b.x), std::max(a.x, b.x), in.left, in.right);
        const auto [top, bottom] = reach(std::min(a.y, b.y), std::max(a.y, b.y), in.top, in.bottom);
        used = {std::min(used.left, left), std::min(used.top, top), std::max(used.right, right),
                std::max(used.bottom, bottom)};
        for (int y = top; y < bottom; ++y) {
            for (int x = left; x < right; ++x) {
                const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
                const double along =
                    length > 0.0 ? std::clamp((px * dx + py * dy) / length, 0.0, length) : 0.0;
                const double scale = length > 0.0 ? along / length : 0.0;
                if (dash_px > 0.0 && std::fmod(run_px + along, 2.0 * dash_px) > dash_px) continue;
                const double away = std::hypot(px - scale * dx, py - scale * dy);
                const auto c = static_cast<float>(std::clamp(half + 0.5 - away, 0.0, 1.0));
                float& most = coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                                        static_cast<std::size_t>(x)];
                most = std::max(most, c);
            }
        }
        run_px += length;
    }
    for (int y = used.top; y < used.bottom; ++y) {
        for (int x = used.left; x < used.right; ++x) {
            float& c = coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                                 static_cast<std::size_t>(x)];
            if (c > 0.0F) blend(x, y, colour, static_cast<double>(c));
            c = 0.0F;
        }
    }
}

void Canvas::text(const Font& font, std::string_view words, Pixel at, int size_px, Colour colour,
                  Anchor anchor) {
    const auto all = font.glyphs(words, size_px);
    double pen = at.x;
    double sum = 0.0;
    for (const auto& g : all) sum += g.advance;
    if (anchor == Anchor::middle) pen -= sum / 2.0;
    if (anchor == Anchor::right) pen -= sum;
    const int base = static_cast<int>(std::lround(at.y));
    for (const auto& g : all) {
        const int left = static_cast<int>(std::lround(pen)) + g.left;
        for (int y = 0; y < g.height; ++y)
            for (int x = 0; x < g.width; ++x)
                blend(left + x, base - g.top + y, colour,
                      g.coverage[static_cast<std::size_t>(y * g.width + x)] / 255.0);
        pen += g.advance;
    }
}

}  // namespace tact::plot
