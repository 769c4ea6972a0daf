// Interprets the output of `tact dock|touch|drill --bake-only`: progress and messages.
//
// Input    from another program, bounded by ChildJob.  Never fails.  Thread any.
#pragma once

#include <optional>
#include <string>

namespace tact {

// The last non-empty line.
[[nodiscard]] std::string last_line(const std::string& output);
// Completed fraction, 0 to 1, from the last line "[ 45 %] step"; nullopt: no such line.
[[nodiscard]] std::optional<double> share_done(const std::string& output);
// The output from the first error message on, without the successful steps before it.
[[nodiscard]] std::string error_text(const std::string& output);

}  // namespace tact
