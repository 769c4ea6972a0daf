// What files mean that a person drops onto the window: a scene to open, or raw data that `tact` bakes into one.
//
// By their endings alone; what is in them is for tact-prep to say.  Fails by words.  Thread any.
#pragma once

#include <string>
#include <vector>

namespace tact {

inline constexpr std::size_t kDroppedMost = 17;  // a map and as many structures as a scene holds

struct Dropped {
    std::string scene;  // to open
    std::vector<std::string>
        import;           // words of `tact`: {"dock", MAP, MODEL...}, {"touch", MESH}, {"drill", SCAN}
    std::string trouble;  // what cannot be done, why, and what to do instead
};

[[nodiscard]] Dropped meaning_of(const std::vector<std::string>& files);

}  // namespace tact
