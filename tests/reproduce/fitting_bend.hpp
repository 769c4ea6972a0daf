// A structure bends into the map of its bent self, led by the docking force alone.
//
// Answer   the structure bent along its six softest modes, in random directions, softer modes farther, to kBentM in all. One that
//          changes a distance of neighbours along a chain by more than kTornStrain is torn, not bent: another is drawn, up to
//          kDrawsMost times
// Map      simulated from the answer at kBentResolutionM, voxels of a quarter of that
// Hand     as in fitting_hand.hpp, for kBendSeconds of its own time, from the place in the file; the body bends along kBendModes modes
// Thread   slow: seconds per run
#pragma once

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact::launch {

inline constexpr double kBentM = 4.0 * kAngstromM, kBentResolutionM = 8.0 * kAngstromM, kBendSeconds = 15.0;
inline constexpr std::uint32_t kBendModes = 12;
inline constexpr double kTornStrain = 0.5;
inline constexpr int kDrawsMost = 200;

struct Bending {
    double left_m =
        -1.0;      // of the atoms from those of the answer, root mean square; negative: there is no answer
    int torn = 0;  // answers that were drawn before it
};
[[nodiscard]] Bending bend_back(const Structure& structure, SeededRandom& random);

}  // namespace tact::launch
