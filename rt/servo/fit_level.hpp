// The level of the haptic path, chosen by LevelFit from the costs of the models' steps.
//
// Dry cycles  try each level in turn, so the first armed cycle has the level that it will keep.
// Law         "fixed" leaves the level to the person; the costs are learned all the same.
// Thread      servo; TACT_RT. Rows are made anew when another model or structure comes into the hand.
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Candidate levels of the model in the first hand.
void make_level_rows(CycleState& c) noexcept TACT_RT;
// After a dry cycle.
void calibrate_level(CycleState& c) noexcept TACT_RT;
// Before the first cycle that counts, and for another model: the level that fits.
void choose_level(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Once a cycle. True: the level changed.
bool fit_level(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Once an interval: lowers the highest level while the slow update does not keep its period and no visual path can give.
void limit_by_slow_update(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
