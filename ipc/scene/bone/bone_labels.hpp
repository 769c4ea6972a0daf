// The structure of each voxel of a bone volume, and the table of structures.
//
// Label    0: none; 1 to 255: row label - 1 of the table. One byte per voxel, in the order of the bone's
//          BoneBricks.
// Critical structures are those that a surgeon must avoid: nerves, vessels, dura. Each has a distance
// field.
// Section  LABL: a header of 64 bytes, the table with 64 bytes per row, the labels. A view of the mapped
//          file.
// Thread   immutable; the file outlives the view
// Errors   StartupError: counts, names, length, labels without a row, a size other than the bone's
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct BoneStructure {
    static constexpr std::size_t kNameBytesMax = 47;  // UTF-8
    std::string name;
    std::array<std::uint8_t, 4> rgba{};
    bool critical = false;
};

struct BoneLabelsView {
    std::vector<BoneStructure> structure;  // for label 1, 2, …
    std::span<const std::uint8_t> label;   // bricks.bytes()

    [[nodiscard]] bool critical(std::uint8_t l) const { return l > 0 && structure[l - 1U].critical; }
};

// Output of tact-prep, and content of the sections.
struct BoneData {
    BoneBricks bricks;
    float hu_at_0 = std::numeric_limits<float>::quiet_NaN();
    float hu_at_255 = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::uint8_t> density;
    std::vector<BoneStructure> structure;  // empty: no labels
    std::vector<std::uint8_t> label;       // empty, or one per density
    std::optional<PatientFrame> patient;   // as the scan states

    [[nodiscard]] BoneVolumeView view() const { return {bricks, hu_at_0, hu_at_255, density}; }
};

bool has_bone_labels(const SceneFile& file);
// Throws StartupError for a view that could not be read again.
void write_bone_labels(SceneWriter& out, const BoneBricks& bricks, const BoneLabelsView& labels);
BoneLabelsView read_bone_labels(const SceneFile& file, const BoneBricks& bricks);

}  // namespace tact
