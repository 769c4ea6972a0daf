// How far simplification lets a triangle turn, in one contraction and in one round of relaxation.
#pragma once

namespace tact {

template <class T>
inline constexpr T kTurnCosine = T(0.5);  // by 60 degrees
// And it comes no nearer than 26 degrees to lying on its neighbour.
template <class T>
inline constexpr T kFoldCosine = T(-0.9);

}  // namespace tact
