// Converts plain text to roff, the language of man pages.
#pragma once

#include <string>

namespace tact::manual {

// Escapes characters with a meaning in roff and writes those beyond ASCII by number; no line begins with a
// request.
std::string roff(const std::string& text);
// The same, in bold or italic.
std::string bold(const std::string& text);
std::string italic(const std::string& text);

}  // namespace tact::manual
