// The calibration of the stage in the window: keys, clicks and typed numbers go to it, its words and pictures come from it, and
// its result goes into the stage file.
//
// Thread   frame thread
// Fails by words on the card; nothing that is measured is lost by a file that cannot be written
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
    // From what the stage is now; from the step of the test picture where that alone is wanted.
    void begin(const StageSettings& now, bool check_alone);
    void perform(CalibrationAction what, std::size_t number = 0);
    void swap_eyes();
    // True: a person wants to leave.
    bool follow(const Controller& controller, std::int64_t now_ns, CalibrationCardState& state);
    void end(CalibrationCardState& state);
    // What the stage has to be when the calibration is left: as it was, or as it was saved last.
    [[nodiscard]] const StageSettings& kept() const { return kept_; }
    [[nodiscard]] const StageSettings& draft() const { return calibration_->draft(); }
    void set_mode(StereoMode mode) { calibration_->set_mode(mode); }
    // The chosen way to show it does not work here.
    void refuse_mode(StereoMode back_to, const std::string& why);
    // For the eye that the picture is meant for; reach_mm(): how far from the glass's middle anything of it lies.
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
