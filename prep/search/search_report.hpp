// What a search found, as a table for a person, as JSON and as CSV.
//
// JSON    hits[]: model, rank, score, z, cc_about_mean, clashes (with the fixed structures) and matrix: 3 x 4, row-major, from
//         the coordinates of the model's file to those of the map, angstrom. searches[]: one per model, how it was searched,
//         and the symmetry of its copies: name, axis, a point of it (through_a, in the map), correlation of all copies
// CSV     one row per model: its best hit; matrix in twelve columns
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prep/search/place_symmetric.hpp"

namespace tact {

struct SearchedModel {
    std::string model;  // as given
    Structure structure;
    SearchResult found;
    std::vector<double> cc_about_mean;   // by hit; in the map as it is
    std::vector<std::uint64_t> clashes;  // by hit
    double seconds = 0.0;
    std::optional<PlacedSymmetric> copies{};  // by symmetry; then the hits are the copies
};

struct SearchReport {
    std::string map, objective;
    double resolution_a = 0.0;
    std::vector<std::string> fixed;
    std::vector<SearchedModel> models;
    std::optional<double> together_correlation{};  // of all models together (joint_fit.hpp)
};

[[nodiscard]] std::string as_table(const SearchReport& report);
[[nodiscard]] nlohmann::ordered_json as_json(const SearchReport& report);
[[nodiscard]] std::string as_csv(const SearchReport& report);

}  // namespace tact
