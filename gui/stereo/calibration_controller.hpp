// Calibration of the stage in the window: takes keys, clicks and typed numbers, provides texts and pictures, and
// writes the result to the stage file.
//
// Thread   frame thread
// Fails by a message on the card; a file that cannot be written loses no measurement
#pragma once

#include <filesystem>
#include <optional>

#include "gui/link/controller.hpp"
#include "gui/stereo/calibration.hpp"
#include "gui/stereo/calibration_panel.hpp"
#include "gui/stereo/test_picture.hpp"

namespace tact {

class CalibrationController {
public:
    // file: of the stage; it need not exist.
    explicit CalibrationController(std::filesystem::path file) : file_(std::move(file)) {}

    [[nodiscard]] bool open() const { return calibration_.has_value(); }
    // Starts from the current stage; check_alone: at the step of the test picture.
    void begin(const StageSettings& now, bool check_alone);
    void perform(CalibrationAction what, std::size_t number = 0);
    void swap_eyes();
    // Returns true if the user wants to leave.
    bool follow(const Controller& controller, std::int64_t now_ns, CalibrationCardState& state);
    void end(CalibrationCardState& state);
    // The stage after the calibration: as it was, or as last saved.
    [[nodiscard]] const StageSettings& kept() const { return kept_; }
    [[nodiscard]] const StageSettings& draft() const { return calibration_->draft(); }
    void set_mode(StereoMode mode) { calibration_->set_mode(mode); }
    // The chosen mode does not work here.
    void refuse_mode(StereoMode back_to, const std::string& why);
    // For this eye; reach_mm(): greatest distance of its content from the centre of the glass.
    [[nodiscard]] std::vector<PictureVertex> picture(const GlassSize& glass, std::size_t eye) const;
    [[nodiscard]] double reach_mm(const GlassSize& glass) const;

private:
    void take_typed(CalibrationCardState& state);
    void tell(CalibrationCardState& state) const;
    void save();
    [[nodiscard]] std::optional<Eigen::Vector3d> tool_mm() const;

    std::filesystem::path file_;
    std::optional<Calibration> calibration_;
    StageSettings kept_;
    bool leave_ = false;
    std::string saved_, logged_;
    Grade saved_grade_ = Grade::unknown;
};

}  // namespace tact
