// Limits of one step of a level, shared by the parts of the governor.
#pragma once

namespace tact {

inline constexpr double kDownMost = 1.4, kUpMost = 0.3;  // in ln V
// Levels change by factors. A lower level would need many steps to recover and would save nothing.
inline constexpr double kLeastLevel = 1e-3;

}  // namespace tact
