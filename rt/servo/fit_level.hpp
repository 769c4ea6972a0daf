// Chooses the level of the haptic path with LevelFit from the costs of the models' steps.
//
// Dry cycles  measure each level in turn, then run at the level that fits, so the first armed cycle already has it.
// Rows        levels from governor.force_level_min up; rebuilt when another model or structure comes into the hand.
// Law         "fixed" leaves the level to the person; the cost statistics are updated all the same.
// Thread      servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets the candidate levels of the model in the first hand.
void make_level_rows(CycleState& c) noexcept TACT_RT;
// Call after a dry cycle.
void calibrate_level(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Sets the level that fits, before the first regular cycle and for another model.
void choose_level(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Call once a cycle. True: the level changed.
bool fit_level(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Call once an interval. Lowers the level limit while the slow update misses its period and no visual level can fall.
void limit_by_slow_update(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
