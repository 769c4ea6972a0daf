// Calibration of a stage, step by step: size of the display, pose of its screen, pose of the hand's world, and the
// eyes. User actions come in as calls, topics through follow(); the result is a draft of the stage's settings, which
// changes only after a good measurement.
//
// Frames   screen: that of the topic `head`. Glass: metres in the display's plane, x right, y up, from its centre.
// Thread   frame thread; plain arithmetic, no window and no file
// Fails by message() and the status text of a step
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gui/stereo/registration.hpp"
#include "gui/stereo/rest_window.hpp"
#include "gui/stereo/stage_file.hpp"

namespace tact {

enum class CalibrationStep : std::uint8_t { picture, wand, screen, workspace, eyes, check };
inline constexpr std::size_t kCalibrationSteps = 6;

// Marks on the display, as fractions of its width and height from the lower left: four near its corners, the centre,
// and one more, so that a reversed order shows in the residuals.
inline constexpr std::size_t kMarks = 6, kMarksMin = 4;
inline constexpr std::array<std::array<double, 2>, kMarks> kMarkPlaces{
    {{0.08, 0.1}, {0.92, 0.1}, {0.92, 0.9}, {0.08, 0.9}, {0.5, 0.5}, {0.7, 0.3}}};

// Current data from the controller.
struct CalibrationInput {
    double now_s = 0.0;
    bool sensor_good = false;  // fresh, from the tracked sensor
    std::int64_t sensor_at_ns = 0;
    Pose T_screen_sensor;
    bool hand_good = false;
    std::int64_t hand_at_ns = 0;
    Vec3 stylus_world_m = Vec3::Zero();
    bool button = false;  // any button of the hand
};

class Calibration {
public:
    struct Mark {
        bool taken = false;
        Vec3 from_m = Vec3::Zero(), to_m = Vec3::Zero();  // glass or world; screen
        double spread_m = 0.0;                            // during the measurement, the larger of the two
        std::size_t samples = 0;
    };
    struct Marks {
        std::array<Mark, kMarks> mark;
        std::size_t current = 0;  // kMarks: all are measured
        Registration fit;
        std::vector<std::size_t> of_fit;  // mark of each pair of the fit
        [[nodiscard]] std::size_t taken() const;
        // Of a mark; none if it is not part of a fit.
        [[nodiscard]] std::optional<double> residual_m(std::size_t of_mark) const;
        [[nodiscard]] std::optional<std::size_t> outlier() const;
    };
    struct StatusText {
        FitGrade grade = FitGrade::none;
        std::string text;
    };

    explicit Calibration(const StageSettings& start) : draft_(start) {}

    void follow(const CalibrationInput& input);

    [[nodiscard]] CalibrationStep step() const { return step_; }
    void go(CalibrationStep step);
    void next() {
        go(static_cast<CalibrationStep>(std::min<int>(static_cast<int>(step_) + 1, kCalibrationSteps - 1)));
    }
    void back() { go(static_cast<CalibrationStep>(std::max(static_cast<int>(step_) - 1, 0))); }

    // Missing prerequisite for measuring a mark, or the wand's tip.
    enum class Lacking : std::uint8_t { nothing, size, tracker, hand };
    [[nodiscard]] Lacking lacking() const;
    // Starts or stops measuring the current mark; in the wand step: the tilting about its tip.
    void take();
    void skip();                  // to the next mark not yet measured
    void redo(std::size_t mark);  // clears it and makes it current
    void redo_last();
    void clear();  // all marks of this step

    // Typed values. Invalid ones change nothing and set message().
    void set_picture_size(double width_m, double height_m);
    void use_measured_size();
    void set_screen(const ScreenPlace& place);
    void set_wand_tip(const Vec3& tip_sensor_m);
    void set_eyes(const EyesOfHead& eyes);
    void set_mode(StereoMode mode) { draft_.mode = mode; }
    void set_in_workspace(bool in_workspace) { draft_.in_workspace = in_workspace; }
    // The stylus touches the wand, anywhere; or the marks on the display.
    void set_workspace_by_wand(bool by_wand);

    [[nodiscard]] const StageSettings& draft() const { return draft_; }
    [[nodiscard]] const Marks& marks() const {
        return step_ == CalibrationStep::workspace ? workspace_ : screen_;
    }
    [[nodiscard]] bool workspace_by_wand() const { return by_wand_; }
    [[nodiscard]] bool measuring() const;
    [[nodiscard]] double progress() const;  // of the current mark
    // Size computed from the touched marks; zero with fewer than four.
    [[nodiscard]] Eigen::Vector2d measured_size_m() const { return measured_size_m_; }
    // Current positions, screen frame; none while not tracked.
    [[nodiscard]] std::optional<Vec3> wand_tip_screen_m() const;
    [[nodiscard]] std::optional<Vec3> stylus_screen_m() const;

    [[nodiscard]] std::string instruction() const;
    [[nodiscard]] std::string glass_text() const;  // the same in capitals, to be read on the glass
    [[nodiscard]] std::string live() const;        // values being measured
    [[nodiscard]] StatusText status() const;       // of this step
    [[nodiscard]] StatusText status(CalibrationStep step) const;
    [[nodiscard]] const std::string& message() const { return message_; }  // result of the last action
    [[nodiscard]] std::vector<std::string> remarks() const;                // measured values, for the file

private:
    [[nodiscard]] Marks& own_marks() { return step_ == CalibrationStep::workspace ? workspace_ : screen_; }
    [[nodiscard]] Vec3 glass_m(std::size_t mark) const;
    [[nodiscard]] Pose T_screen_glass() const;
    void follow_mark();
    void follow_turning();
    void keep_mark();
    void fit();
    void say(std::string words) { message_ = std::move(words); }

    // For a magnetic tracker half a metre away, and for an arm's encoders in a still hand.
    static constexpr double kWandSpreadM = 4e-3, kStylusSpreadM = 2e-3;
    static constexpr double kTurningS = 8.0;
    // A source that paused for a moment may be measured, because measuring waits for it; a missing one is reported at
    // once.
    static constexpr double kAwayS = 1.0;

    StageSettings draft_;
    CalibrationInput input_;
    CalibrationStep step_ = CalibrationStep::picture;
    Marks screen_, workspace_;
    bool by_wand_ = false, typed_screen_ = false, button_before_ = true;
    RestWindow wand_{kWandSpreadM}, stylus_{kStylusSpreadM};
    std::size_t last_taken_ = kMarks;
    Eigen::Vector2d measured_size_m_ = Eigen::Vector2d::Zero();
    double sensor_heard_s_ = -1e9, hand_heard_s_ = -1e9;
    bool turning_ = false;
    double turning_from_s_ = 0.0;
    std::int64_t turned_at_ns_ = 0;
    std::vector<Pose> turned_;
    std::optional<PivotFit> pivot_;
    std::string message_;
};

[[nodiscard]] const char* calibration_step_title(CalibrationStep step);

}  // namespace tact
