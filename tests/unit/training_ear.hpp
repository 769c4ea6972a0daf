// A porous ear with a nerve and an oblique patient, and a task in it: for tests of training.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "gui/drilling/training/training.hpp"

namespace tact::training_test {

namespace fs = std::filesystem;
inline constexpr double kVoxelM = 4e-4;
inline constexpr std::uint32_t kX = 45, kY = 38, kZ = 29;  // no multiples of a brick

struct Folder {
    fs::path path = fs::temp_directory_path() / ("tact-training-" + std::to_string(::getpid()));
    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

// Porous bone with a nerve, a plane at x = 12 mm of the scan, in a patient who lies oblique.
struct Ear {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    BoneVolumeView volume;
    BoneLabelsView labels;
    std::vector<std::uint8_t> label;
    std::vector<std::int16_t> quanta;
    std::vector<DistanceField> fields;
    PatientFrame patient;

    Ear() {
        bricks.size = {kX, kY, kZ};
        bricks.voxel_m = kVoxelM;
        bricks.origin_m = Vec3(1e-3, -2e-3, 5e-3);
        density.assign(bricks.bytes(), 0);
        std::mt19937 random(3);
        each([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            density[bricks.voxel(x, y, z)] =
                random() % 5 == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(random() % 256);
        });
        volume.bricks = bricks;
        volume.density = density;
        label.assign(bricks.bytes(), 0);
        labels.structure = {{"facial <nerve>", {255, 221, 64, 255}, true},
                            {"malleus", {1, 2, 3, 255}, false}};
        labels.label = label;
        DistanceField f;
        f.label = 1;
        f.size = {12, 12, 12};
        f.spacing_m = 2e-3;
        f.origin_m = bricks.origin_m - Vec3::Constant(1e-3);
        f.quantum_m = 1e-6;
        f.error_m = 1e-6;
        for (std::uint32_t i = 0; i < 12 * 12 * 12; ++i)
            quanta.push_back(static_cast<std::int16_t>(
                std::lround((12e-3 - (f.origin_m.x() + f.spacing_m * (i % 12))) / f.quantum_m)));
        f.quanta = quanta;
        fields = {f};
        patient.axes = Eigen::AngleAxisd(0.6, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
        patient.origin_mm = Vec3(31.0, -12.0, 400.0);
    }
    template <class Do>
    void each(Do&& visit) const {
        for (std::uint32_t z = 0; z < kZ; ++z)
            for (std::uint32_t y = 0; y < kY; ++y)
                for (std::uint32_t x = 0; x < kX; ++x) visit(x, y, z);
    }
    [[nodiscard]] Vec3 at_mm(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return 1e3 * (bricks.origin_m + kVoxelM * Vec3(x, y, z));
    }
    [[nodiscard]] TrainingBone bone() const {
        return {
            .volume = &volume, .labels = &labels, .distances = fields, .patient = &patient, .checksum = 77};
    }
};

inline TrainingPlan plan_of(const std::string& text, const fs::path& folder = {}) {
    return read_training_plan_text(text, "task.toml", folder);
}
inline constexpr const char* kTask = R"(
title = "T"
[[goal]]
name = "ball"
sphere = { centre_mm = [8, 4, 10], radius_mm = 3.3 }
share = 0.5
[[goal]]
name = "box"
box = { from_mm = [9, 8, 12], to_mm = [6, 3, 8] }
[[thin]]
structure = "facial <nerve>"
leave_mm = 1.5
share = 0.1
[[forbidden]]
structure = "facial <nerve>"
margin_mm = 0.7
[[forbidden]]
name = "corner"
sphere = { centre_mm = [3, 0, 7], radius_mm = 2.03 }
most_mm3 = 0.05
)";

}  // namespace tact::training_test
