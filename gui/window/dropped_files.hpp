// What files mean that a person drops onto the window or marks in a list: a scene to open, or raw data that `tact` bakes
// into one.
//
// By their endings alone; what is in them is for tact-prep to say.  Fails by words.  Thread any.
#pragma once

#include <string>
#include <vector>

namespace tact {

inline constexpr std::size_t kDroppedMost = 17;  // a map and as many structures as a scene holds

// What can be dropped, as a sentence.
extern const char* const kDroppedKinds;

enum class RawKind { none, scene, map, structure, mesh, scan };
// Of a file, by the ending of its name; no disk is asked.
[[nodiscard]] RawKind file_kind(const std::string& name);
[[nodiscard]] const char* raw_kind_text(RawKind kind);  // "map", ...; none: empty

struct Dropped {
    std::string scene;  // to open
    std::vector<std::string>
        import;           // words of `tact`: {"dock", MAP, MODEL...}, {"touch", MESH}, {"drill", SCAN}
    std::string trouble;  // what cannot be done, why, and what to do instead
};

[[nodiscard]] Dropped meaning_of(const std::vector<std::string>& files);
// One line: "Dock 1abc.pdb into emd.mrc.", or what is in the way.
[[nodiscard]] std::string meaning_text(const Dropped& meant);

}  // namespace tact
