// Reads the places that tact-search and tact-refine wrote as JSON (prep/search/search_report.hpp).
//
// Hostile   sizes, finite numbers and rotations are checked
// Fails by  StartupError
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr std::size_t kFoundMax = 20;  // further ones are left out

struct FoundPlace {
    Pose T_model_body;
    double score = 0.0;        // of the objective
    double score_start = 0.0;  // of a refinement: of the place that it was given
    double z = 0.0;            // standard deviations above random places; 0: not known
    std::uint64_t clashes = 0;
};

// Best first. home_com_model_m: the centre of mass in the structure's file, which the matrices start from. nearby: of a refinement,
// which has exactly one place.
[[nodiscard]] std::vector<FoundPlace> read_found(std::string_view json, const Vec3& home_com_model_m,
                                                 bool nearby);

// The symmetry of copies that a search placed, such as "C7"; empty if it placed none.
[[nodiscard]] std::string found_symmetry(std::string_view json);

}  // namespace tact
