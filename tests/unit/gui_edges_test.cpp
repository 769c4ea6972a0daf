// Smoothing of stair-stepped edges, compared with the exact coverage of each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gui/render/edge_smoothing.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact::gui_edges_test {
namespace {

constexpr int kSize = 128, kMargin = 9;
using EdgesDrawn = Canvas<kSize, kSize>;

// White below y = at + slope x, or left of x = at + slope y, drawn in steps as without multisampling.
struct Edge {
    double at, slope;
    bool steep;
    void draw() const {
        glViewport(0, 0, kSize, kSize);
        glClearColor(0.1F, 0.1F, 0.1F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        glEnable(GL_SCISSOR_TEST);
        glClearColor(0.9F, 0.9F, 0.9F, 1.0F);
        for (int i = 0; i < kSize; ++i) {
            const int most = static_cast<int>(std::lround(at + slope * (i + 0.5)));
            steep ? glScissor(0, i, most, 1) : glScissor(i, 0, 1, most);
            glClear(GL_COLOR_BUFFER_BIT);
        }
        glDisable(GL_SCISSOR_TEST);
    }
    // Fraction of a pixel that is white; y from below.
    [[nodiscard]] double share(int x, int y) const {
        if (steep) std::swap(x, y);
        double sum = 0.0;
        for (int k = 0; k < 16; ++k) sum += std::clamp(at + slope * (x + (k + 0.5) / 16) - y, 0.0, 1.0) / 16;
        return sum;
    }
};

double error(const Edge& edge, const Image& image) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = kMargin; x < kSize - kMargin; ++x) {
            const double share = edge.share(x, y), ideal = 255.0 * (0.1 + 0.8 * share);
            const auto at =
                3U * (static_cast<std::size_t>(kSize - 1 - y) * kSize + static_cast<std::size_t>(x));
            if (share <= 0.0 || share >= 1.0) continue;
            sum += std::pow(image.rgb[at] - ideal, 2);
            ++count;
        }
    return std::sqrt(sum / std::max(count, 1));
}

TEST_F(EdgesDrawn, smoothed_stairs_are_close_to_the_ideal_edge) {
    EdgeSmoothing edges;
    for (const Edge edge : {Edge{30.3, 0.13, false}, Edge{30.3, 0.37, false}, Edge{90.8, -0.21, false},
                            Edge{30.6, 0.18, true}, Edge{100.1, -0.33, true}}) {
        edge.draw();
        const double stairs = error(edge, read_pixels(kSize, kSize));
        edges.smooth(0, 0, kSize, kSize);
        const double smooth = error(edge, read_pixels(kSize, kSize));
        EXPECT_GT(stairs, 30.0);
        EXPECT_LT(smooth, 0.5 * stairs) << "slope " << edge.slope << (edge.steep ? ", steep" : "");
    }
}

TEST_F(EdgesDrawn, change_nothing_else) {
    const Edge edge{40.0, 0.25, false};
    edge.draw();
    const Image before = read_pixels(kSize, kSize);
    EdgeSmoothing edges;
    glViewport(0, 0, kSize / 2, kSize);
    edges.smooth(0, 0, kSize / 2, kSize);  // the right half is outside the area
    const Image after = read_pixels(kSize, kSize);
    int changed = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const auto at =
                3U * (static_cast<std::size_t>(kSize - 1 - y) * kSize + static_cast<std::size_t>(x));
            if (before.rgb[at] == after.rgb[at]) continue;
            ++changed;
            EXPECT_LT(x, kSize / 2);
            EXPECT_LE(std::abs(y + 0.5 - (edge.at + edge.slope * (x + 0.5))), 2.0) << x << ", " << y;
        }
    EXPECT_GT(changed, kSize / 4);
}

}  // namespace
}  // namespace tact::gui_edges_test
