// A training task: what to remove, what to thin, what to leave, in which time. Read from a TOML file.
//
// Form     deploy/tact/drilling/README.md describes it; deploy/training/mastoid.toml is an example
// Units    mm of the scan, in the scene's axes or in the patient's (LPS); shares from 0 to 1
// Fails    by StartupError with the file, the line, what is wrong and what is expected; an unknown key is an error
// Thread   any
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

// A part of the bone.
struct TrainingRegion {
    enum class Kind : std::uint8_t { sphere, box, expert, structure };
    Kind kind = Kind::sphere;
    Vec3 a_mm = Vec3::Zero(), b_mm = Vec3::Zero();  // centre; or two opposite corners
    double radius_mm = 0.0;
    std::filesystem::path expert;  // what an expert removed: a file of drilled bone
    std::string structure;         // by its name, as in the scene
    double margin_mm = 0.0;        // about it
};

struct TrainingGoal {
    std::string name;
    TrainingRegion region;
    double share = 0.9;  // of its bone
};
struct TrainingThin {
    std::string structure;
    double leave_mm = 1.0, share = 0.2;  // so much of the bone at this distance from it is to go
};
struct TrainingForbidden {
    std::string name;
    TrainingRegion region;
    double most_mm3 = 0.1;  // that may go
};

enum class TrainingPart : std::uint8_t { goal, outside, thin, structures, force, sight, time, count };
inline constexpr std::array<const char*, static_cast<std::size_t>(TrainingPart::count)> kTrainingPartNames{
    "goal", "outside", "thin", "structures", "force", "sight", "time"};

struct TrainingPlan {
    static constexpr std::size_t kRegionsMost = 16;  // of each kind
    std::string title, task;
    bool patient = false;  // frame of all millimetres
    double time_s = 0.0;   // 0: as long as it takes
    std::vector<TrainingGoal> goal;
    std::vector<TrainingThin> thin;
    std::vector<TrainingForbidden> forbidden;
    std::array<double, static_cast<std::size_t>(TrainingPart::count)> points{40, 15, 10, 20, 5, 5, 5};
};

// name: for messages. folder: of relative file names in it.
[[nodiscard]] TrainingPlan read_training_plan_text(std::string_view text, const std::string& name,
                                                   const std::filesystem::path& folder);
[[nodiscard]] TrainingPlan read_training_plan(const std::filesystem::path& path);

}  // namespace tact
