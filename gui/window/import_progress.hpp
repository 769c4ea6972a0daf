// What `tact dock|touch|drill --bake-only` printed up to now: how far it is, and what it says.
//
// Input    another program's, bounded by ChildJob.  Fails by nothing told.  Thread any.
#pragma once

#include <optional>
#include <string>

namespace tact {

// The last line that is not empty.
[[nodiscard]] std::string last_line(const std::string& output);
// Of the whole, 0 to 1, from the last line "[ 45 %] what is done"; nothing: no line says it.
[[nodiscard]] std::optional<double> share_done(const std::string& output);
// From the first word of an error on: before it are the steps that went well.
[[nodiscard]] std::string error_text(const std::string& output);

}  // namespace tact
