// A contour on the command line and in sessions: LEVEL[:RRGGBB][:OPACITY][:STYLE][:hidden].
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gui/render/contours.hpp"

namespace tact {

enum class LevelUnit { map, sigma, volume };  // volume: enclosed fraction of the map's box

struct ContourOption {
    double value = 0.0;
    LevelUnit unit = LevelUnit::map;
    std::optional<Eigen::Vector3f> colour;
    float opacity = 1.0F;
    std::optional<SurfaceStyle> style;
    bool shown = true;
};

// "1.5", "2.5s", "8%", "0.7:ffc259:0.5:solid". Throws CLI::ValidationError with a message.
[[nodiscard]] ContourOption read_contour_option(const std::string& text);
// Reading it gives the contour, its level to the last digit.
[[nodiscard]] std::string contour_option_text(const Contour& contour);
[[nodiscard]] double level_of(const ContourOption& option, const ContourScale& scale);
[[nodiscard]] std::vector<Contour> contours_of(std::span<const ContourOption> options,
                                               const ContourScale& scale);

}  // namespace tact
