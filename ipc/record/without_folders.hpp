// What a recording keeps of paths: file names. Folders tell who ran it, and a recording is given away.
//
// Thread   any. Whatever the bytes, what comes out is no longer than what went in and holds no '/'.
#pragma once

#include <string>
#include <string_view>

namespace tact {

// Of "/home/anna/rod.tact" rod.tact; of a text without '/' the text; "." where nothing is left.
[[nodiscard]] std::string without_folders(std::string_view path);
// Each argument ends with 0. "--poses=/home/anna/p.json" becomes "--poses=p.json".
[[nodiscard]] std::string arguments_without_folders(std::string_view arguments);

}  // namespace tact
