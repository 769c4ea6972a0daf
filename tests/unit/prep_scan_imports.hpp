// Imports of the scans of prep_scan_samples.hpp, and what they must give.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "ipc/base/error.hpp"
#include "prep/drilling/import_bone.hpp"
#include "tests/unit/prep_scan_samples.hpp"

namespace tact::sample {

inline std::string numbered(std::string name, int number, const char* ending = "") {
    name += std::to_string(number);
    name += ending;
    return name;
}

template <class Call>
std::string told(Call&& call) {
    try {
        call();
    } catch (const StartupError& error) {
        return error.what();
    }
    return "no error";
}

inline BoneImport of(const std::filesystem::path& scan) {
    BoneImport o;
    o.scan = scan;
    return o;
}
inline std::string refusal(const BoneImport& o) {
    return told([&] { (void)import_bone(o); });
}

// The patient faces the user: x to the patient's left, y up, z forward.
inline void expect_bone(const BoneData& bone) {
    ASSERT_EQ(bone.bricks.size, (std::array<std::uint32_t, 3>{kLeft, kUp, kBack}));
    EXPECT_NEAR(bone.bricks.voxel_m, 1e-3, 1e-9);
    for (int l = 0; l < kLeft; ++l)
        for (int b = 0; b < kBack; ++b)
            for (int u = 0; u < kUp; ++u)
                ASSERT_EQ(bone.density[bone.bricks.voxel(static_cast<std::uint32_t>(l),
                                                         static_cast<std::uint32_t>(u),
                                                         static_cast<std::uint32_t>(kBack - 1 - b))],
                          bone_density(l, b, u))
                    << l << ' ' << b << ' ' << u;
}
inline BoneImport hu(BoneImport o) {  // the volume contains no air, so the threshold is given explicitly
    o.threshold = 300.0;
    o.solid = 1800.0;
    return o;
}

}  // namespace tact::sample
