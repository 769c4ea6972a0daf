#include "gui/docking/contour_option.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace tact {
namespace {

// Parses the whole text as a finite number.
std::optional<double> number(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<Eigen::Vector3f> colour_of(const std::string& text) {
    if (text.size() != 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        return std::nullopt;
    const unsigned long c = std::strtoul(text.c_str(), nullptr, 16);
    return Eigen::Vector3f(static_cast<float>(c >> 16U), static_cast<float>(c >> 8U & 255U),
                           static_cast<float>(c & 255U)) /
           255.0F;
}

}  // namespace

ContourOption read_contour_option(const std::string& text) {
    const auto refuse = [&text](const std::string& part) {
        throw CLI::ValidationError(
            "--contour", "'" + part + "' in '" + text + "' is not a level, colour, opacity or style");
    };
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == ':')
            parts.emplace_back();
        else
            parts.back() += c;
    ContourOption option;
    std::string level = parts.front();
    if (!level.empty() && (level.back() == 's' || level.back() == '%')) {
        option.unit = level.back() == 's' ? LevelUnit::sigma : LevelUnit::volume;
        level.pop_back();
    }
    if (const auto value = number(level))
        option.value = option.unit == LevelUnit::volume ? 0.01 * *value : *value;
    else
        refuse(parts.front());
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::string& p = parts[i];
        if (const auto c = colour_of(p)) {
            option.colour = c;
        } else if (const auto o = number(p); o && *o >= 0.0 && *o <= 1.0) {
            option.opacity = static_cast<float>(*o);
        } else if (p == "glass") {
            option.style = SurfaceStyle::glass;
        } else if (p == "solid") {
            option.style = SurfaceStyle::solid;
        } else if (p == "wire") {
            option.style = SurfaceStyle::wire;
        } else if (p == "hidden") {
            option.shown = false;
        } else {
            refuse(p);
        }
    }
    return option;
}

std::string contour_option_text(const Contour& c) {
    char text[96];
    const auto byte = [](float v) {
        return static_cast<int>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
    };
    std::snprintf(text, sizeof text, "%.17g:%02x%02x%02x:%.9g", c.level, byte(c.colour.x()),
                  byte(c.colour.y()), byte(c.colour.z()), static_cast<double>(c.opacity));
    std::string out = text;
    if (c.style)
        out += *c.style == SurfaceStyle::glass   ? ":glass"
               : *c.style == SurfaceStyle::solid ? ":solid"
                                                 : ":wire";
    return c.shown ? out : out + ":hidden";
}

double level_of(const ContourOption& option, const ContourScale& scale) {
    switch (option.unit) {
        case LevelUnit::sigma:
            return scale.level_of_sigma(option.value);
        case LevelUnit::volume:
            return scale.level_of_fraction(option.value);
        case LevelUnit::map:
            break;
    }
    return option.value;
}

std::vector<Contour> contours_of(std::span<const ContourOption> options, const ContourScale& scale) {
    std::vector<Contour> contours;
    for (const ContourOption& o : options)
        contours.push_back({level_of(o, scale), o.colour.value_or(contour_colour(contours.size())), o.opacity,
                            o.style, o.shown});
    return contours;
}

}  // namespace tact
