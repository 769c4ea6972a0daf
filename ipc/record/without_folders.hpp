// Reduces paths in a recording to file names: folder names identify people, and recordings are passed on.
//
// Thread   any. For any input, the output is not longer than the input and contains no '/'.
#pragma once

#include <string>
#include <string_view>

namespace tact {

// "/home/anna/rod.tact" gives rod.tact; a text without '/' is unchanged; "." if nothing remains.
[[nodiscard]] std::string without_folders(std::string_view path);
// Each argument ends with 0. "--poses=/home/anna/p.json" becomes "--poses=p.json".
[[nodiscard]] std::string arguments_without_folders(std::string_view arguments);

}  // namespace tact
