// Contents of the calibration card and the user's actions there: plain data that the application fills and reads.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

enum class CalibrationAction : std::uint8_t {
    go,  // to step `number`
    next,
    back,
    take,
    skip,
    redo,  // point `number`
    redo_last,
    clear,
    measured_size,
    save,
    leave,
};

struct CalibrationCardState {
    struct Step {
        std::string title, text;
        Grade grade = Grade::unknown;
    };
    struct Point {
        std::string text;
        Grade grade = Grade::unknown;
        bool current = false, taken = false;
    };
    bool open = false;
    std::vector<Step> steps;
    std::size_t step = 0;
    std::string instruction, live, message;
    StatusText status;
    std::vector<Point> points;
    bool measuring = false, can_take = true, size_offered = false;
    float progress = 0.0F;
    std::string file;   // to be written
    std::string saved;  // result of saving
    Grade saved_grade = Grade::unknown;
    bool changed = false;  // since the last save
    // Typed, millimetres; the application takes the values named by `edited`, and does not change them while
    // `editing`.
    std::array<double, 1> width_mm{}, height_mm{}, apart_mm{};
    std::array<double, 3> tip_mm{}, middle_mm{};
    std::array<std::array<double, 3>, 3> corners_mm{};
    bool swapped = false;
    int mode = 0, place = 0, touched_with = 0;  // stereo mode minus one; orbit, workspace; marks, wand
    enum class Typed : std::uint8_t { none, size, tip, corners, eyes, mode, place, touched_with };
    Typed edited = Typed::none;
    bool editing = false;
    std::vector<const char*> modes;  // stereo modes, without "off"
    // Emptied by the application.
    std::vector<std::pair<CalibrationAction, std::size_t>> requests;
};

// Replaces the column's cards during a calibration.
void draw_calibration(const Theme& theme, CalibrationCardState& state, const PixelRect& card);

}  // namespace tact
