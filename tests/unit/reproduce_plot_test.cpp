// Plots: every value that matters is seen, whatever the data; pictures are read back pixel by pixel.
#include "tests/reproduce/plot.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <rapidcheck.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "ipc/base/error.hpp"

namespace tact::plot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

bool is(const Image& image, int x, int y, Colour c) {
    const auto* const p = &image.rgba[4 * static_cast<std::size_t>(y * image.width + x)];
    return p[0] == c.r && p[1] == c.g && p[2] == c.b && p[3] == 255;
}

// Rows in which the colour is found, over columns [from, to).
std::pair<int, int> rows_of(const Image& image, Colour c, int from, int to) {
    int top = image.height, bottom = -1;
    for (int y = 0; y < image.height; ++y)
        for (int x = from; x < to; ++x)
            if (is(image, x, y, c)) {
                top = std::min(top, y);
                bottom = std::max(bottom, y);
            }
    return {top, bottom};
}

int pixels_of(const Image& image, Colour c) {
    int n = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) n += is(image, x, y, c) ? 1 : 0;
    return n;
}

// Without a font on the machine there is nothing to test here, and a person has to know.
class PlotWithFont : public ::testing::Test {
protected:
    void SetUp() override {
        try {
            font_ = std::make_unique<Font>();
        } catch (const StartupError& e) {
            GTEST_SKIP() << e.what();
        }
    }
    std::unique_ptr<Font> font_;
};

TEST(PlotTicks, are_round_inside_evenly_apart_and_not_too_many) {
    EXPECT_TRUE(rc::check([] {
        const double low = *rc::gen::inRange(-1000000, 1000000) * 1e-3;
        const double length = *rc::gen::inRange(1, 1000000) * std::pow(10.0, *rc::gen::inRange(-6, 4));
        const int most = *rc::gen::inRange(3, 15);
        const Range range{low, low + length};
        const auto t = ticks(range, most);
        RC_ASSERT(t.size() >= 2 && t.size() <= static_cast<std::size_t>(std::max(most, 5)));
        const double step = t[1] - t[0];
        const double slack = 1e-6 * step;
        for (std::size_t i = 0; i < t.size(); ++i) {
            RC_ASSERT(t[i] >= range.low - slack && t[i] <= range.high + slack);
            if (i > 0) RC_ASSERT(std::abs(t[i] - t[i - 1] - step) <= slack);
        }
        if (t.size() == 2) return;  // may be the ends themselves
        const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
        RC_ASSERT(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}) < 1e-6);
    }));
}

TEST(PlotTicks, of_an_impossible_range_are_a_single_one) {
    EXPECT_EQ(ticks({5.0, 5.0}, 6), std::vector<double>{5.0});
    EXPECT_EQ(ticks({0.0, kInf}, 6).size(), 1U);
}

TEST(PlotTicks, have_as_many_decimals_as_their_step_and_thousands_apart) {
    EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
    EXPECT_EQ(tick_text(0.5, 0.1), "0.5");
    EXPECT_EQ(tick_text(2000.0, 500.0), "2000");
    EXPECT_EQ(tick_text(12000.0, 2000.0), "12\u202F000");
    EXPECT_EQ(tick_text(1234567.0, 1.0), "1\u202F234\u202F567");
    EXPECT_EQ(tick_text(-3.0, 1.0), "\u22123");
    EXPECT_EQ(tick_text(1e12, 1e11), "1e+12");
}

TEST(PlotDecimate, keeps_the_lowest_and_the_highest_value_and_two_points_a_column) {
    EXPECT_TRUE(rc::check([] {
        const int n = *rc::gen::inRange(1, 4000), columns = *rc::gen::inRange(1, 50);
        std::vector<Point> points;
        double low = kInf, high = -kInf;
        for (int i = 0; i < n; ++i) {
            const double y = *rc::gen::inRange(-100000, 100000);
            points.push_back({static_cast<double>(i), y});
            low = std::min(low, y);
            high = std::max(high, y);
        }
        const auto pieces = decimate(points, {0.0, static_cast<double>(n)}, columns);
        RC_ASSERT(pieces.size() == 1U);
        const auto& p = pieces[0];
        RC_ASSERT(p.size() <= 2 * static_cast<std::size_t>(columns) + 2 || p.size() == points.size());
        RC_ASSERT(
            std::is_sorted(p.begin(), p.end(), [](const Point& a, const Point& b) { return a.x < b.x; }));
        const auto [least, most] =
            std::minmax_element(p.begin(), p.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
        RC_ASSERT(least->y == low && most->y == high);
    }));
}

TEST(PlotDecimate, breaks_a_curve_where_a_value_is_no_number) {
    const std::vector<Point> points{{0, 1}, {1, 2}, {2, kNan}, {3, 4}, {kInf, 5}, {5, 6}};
    const auto pieces = decimate(points, {0.0, 5.0}, 100);
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[0].size(), 2U);
    EXPECT_EQ(pieces[2][0].y, 6.0);
    EXPECT_TRUE(decimate(std::vector<Point>{{kNan, kNan}}, {0.0, 1.0}, 10).empty());
}

TEST(PlotText, malformed_utf8_reads_as_the_replacement_character) {
    EXPECT_EQ(code_points("A\u00C5\u2265"), (std::vector<std::uint32_t>{0x41, 0xC5, 0x2265}));
    EXPECT_EQ(code_points("\xFF"
                          "a\xC3"),
              (std::vector<std::uint32_t>{0xFFFD, 0x61, 0xFFFD}));
}

TEST(PlotFont, a_file_that_is_none_is_named_with_a_mend) {
    try {
        const Font font(std::filesystem::path("/nowhere/at-all.ttf"));
        FAIL() << "no error";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("/nowhere/at-all.ttf"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("fonts-dejavu-core"), std::string::npos);
    }
}

TEST(PlotCanvas, a_line_covers_its_width_and_fades_over_one_pixel) {
    Canvas canvas(40, 40, {255, 255, 255});
    const std::vector<Pixel> line{{0.0, 20.0}, {40.0, 20.0}};
    canvas.polyline(line, {0, 0, 0}, 4.0, {0, 0, 40, 40});
    for (int y = 18; y < 22; ++y) EXPECT_TRUE(is(canvas.image(), 20, y, {0, 0, 0})) << y;
    EXPECT_TRUE(is(canvas.image(), 20, 16, {255, 255, 255}));
    EXPECT_TRUE(is(canvas.image(), 20, 23, {255, 255, 255}));
}

TEST(PlotCanvas, a_line_that_crosses_itself_is_not_darker_there_and_nothing_outside_the_cut_is_touched) {
    Canvas canvas(40, 40, {255, 255, 255});
    const std::vector<Pixel> cross{{-1e9, 20.5}, {1e9, 20.5}, {kNan, 0.0}, {20.5, 1e9}, {20.5, -1e9}};
    canvas.polyline(cross, {0, 0, 0}, 1.0, {10, 10, 30, 30});
    EXPECT_EQ(pixels_of(canvas.image(), {0, 0, 0}), 20 + 20 - 1);
    EXPECT_TRUE(is(canvas.image(), 9, 20, {255, 255, 255}));
    EXPECT_TRUE(is(canvas.image(), 30, 20, {255, 255, 255}));
}

TEST_F(PlotWithFont, one_spike_among_a_million_values_is_seen) {
    Plot plot{.title = "spike",
              .x_label = "time, s",
              .panels = {{.y_label = "rate, Hz", .curves = {{.name = "", .points = {}}}}}};
    auto& points = plot.panels[0].curves[0].points;
    for (int i = 0; i < 1000000; ++i) points.push_back({i * 1e-3, i == 777777 ? 100.0 : 10.0});
    const Image image = draw(plot, *font_);
    const auto [top, bottom] = rows_of(image, okabe_ito(0), 0, image.width);
    // 100 is at 100/106 of the axis, 10 at 10/106: the curve spans more than four fifths of the panel.
    EXPECT_GT(bottom - top, 0.8 * plot.panel_height_px);
}

TEST_F(PlotWithFont, a_higher_value_is_drawn_higher_by_the_scale_of_the_axis) {
    Plot plot{.panels = {{.y_label = "y",
                          .curves = {{.name = "", .points = {{0, 25}, {1, 25}}},
                                     {.name = "", .points = {{0, 75}, {1, 75}}}},
                          .y_min = 0.0,
                          .y_max = 100.0}}};
    plot.panel_height_px = 400;
    const Image image = draw(plot, *font_);
    const int middle = image.width / 2;
    const int y25 = rows_of(image, okabe_ito(0), middle, middle + 1).first,
              y75 = rows_of(image, okabe_ito(1), middle, middle + 1).first;
    EXPECT_NEAR(y25 - y75, 200, 2);
}

TEST_F(PlotWithFont, curves_are_told_apart_by_colour_and_named_in_the_legend) {
    Plot named{.panels = {{.y_label = "y",
                           .curves = {{.name = "one", .points = {{0, 1}, {1, 1}}},
                                      {.name = "two", .points = {{0, 2}, {1, 2}}}}}}};
    Plot bare = named;
    for (auto& c : bare.panels[0].curves) c.name.clear();
    const Image with = draw(named, *font_), without = draw(bare, *font_);
    for (int i = 0; i < 2; ++i) {
        EXPECT_GT(pixels_of(without, okabe_ito(i)), 1000) << i;
        EXPECT_GT(pixels_of(with, okabe_ito(i)), pixels_of(without, okabe_ito(i))) << i;
    }
    EXPECT_GT(with.height, without.height);
}

TEST_F(PlotWithFont, the_shaded_part_is_where_it_is_said_to_be) {
    Plot plot{.panels = {{.y_label = "y",
                          .curves = {{.name = "", .points = {{0, 1}, {10, 1}}}},
                          .spans = {{.x_from = 5.0, .x_to = 10.0, .name = ""}}}}};
    const Image image = draw(plot, *font_);
    int left = image.width, right = -1;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (is(image, x, y, {240, 236, 224})) {
                left = std::min(left, x);
                right = std::max(right, x);
            }
    const auto line = rows_of(image, okabe_ito(0), 0, image.width);
    EXPECT_LE(line.first, line.second);
    EXPECT_NEAR(left, (image.width + 2 * image.width - 2 * right) / 2.0 + 20,
                60);  // about the middle of the axis
    EXPECT_GT(right - left, image.width / 3);
}

TEST_F(PlotWithFont, what_is_said_of_curves_is_in_rows_at_the_head_and_hides_nothing) {
    const auto rows_with = [&](std::vector<Span> spans) {
        Plot plot{.panels = {{.y_label = "y", .spans = std::move(spans), .y_min = 0.0, .y_max = 1.0}}};
        const Image image = draw(plot, *font_);
        int rows = 0, last = 0;
        for (int y = 0; y < image.height; ++y) {
            int coloured = 0;
            for (int x = 0; x < image.width; ++x) {
                const std::uint8_t* const p =
                    &image.rgba[4U * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(x))];
                coloured += std::abs(p[0] - p[2]) > 20 ? 1 : 0;
            }
            if (coloured > image.width / 4) ++rows, last = y;
        }
        EXPECT_LT(last, image.height / 4);
        return rows;
    };
    const Span blue{0.0, 10.0, "", 0}, orange{0.0, 10.0, "", 1};
    const int one = rows_with({blue});
    EXPECT_GT(one, 3);
    EXPECT_EQ(rows_with({blue, blue}), one);
    EXPECT_NEAR(rows_with({blue, orange}), 2 * one, 2);  // a line of the grid may lie on one
    EXPECT_EQ(rows_with({}), 0);
}

TEST_F(PlotWithFont, empty_constant_and_impossible_data_still_give_a_picture) {
    for (const auto& points : std::vector<std::vector<Point>>{{},
                                                              {{0, 0}},
                                                              {{3, 7}, {3, 7}},
                                                              {{kNan, kInf}, {-kInf, kNan}},
                                                              {{0, 1e300}, {1, -1e300}},
                                                              {{1e-300, 1}, {2e-300, 2}}}) {
        Plot plot{
            .title = "t",
            .remark = "r",
            .x_label = "x",
            .panels = {{.y_label = "y", .curves = {{.name = "c", .points = points}}}, {.y_label = "empty"}}};
        const Image image = draw(plot, *font_);
        EXPECT_EQ(image.rgba.size(),
                  4U * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    }
    EXPECT_GT(draw(Plot{}, *font_).width, 0);
}

TEST_F(PlotWithFont, a_saved_picture_reads_back_the_same_and_leaves_no_other_file) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("tact-plot-test-" + std::to_string(getpid()));
    const Plot plot{.title = "saved",
                    .panels = {{.y_label = "y", .curves = {{.name = "c", .points = {{0, 1}, {1, 2}}}}}}};
    const Image image = draw(plot, *font_);
    save(plot, folder / "deep" / "plot.png");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, (folder / "deep" / "plot.png").c_str()), 0);
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr), 0);
    EXPECT_EQ(rgba, image.rgba);
    const auto files = std::distance(std::filesystem::directory_iterator(folder / "deep"), {});
    EXPECT_EQ(files, 1);
    std::filesystem::remove_all(folder);
}

TEST(PlotSave, a_place_that_cannot_be_written_is_named) {
    Image image{.width = 1, .height = 1, .rgba = {0, 0, 0, 255}};
    try {
        save_png(image, "/proc/nowhere/plot.png");
        FAIL() << "no error";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("/proc/nowhere/plot.png"), std::string::npos);
    }
}

}  // namespace
}  // namespace tact::plot
