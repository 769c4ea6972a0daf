// Plain text as roff, the language of man pages.
#pragma once

#include <string>

namespace tact::manual {

// Letters that roff takes for its own are escaped, those beyond ASCII named by their number; no line begins
// with a request.
std::string roff(const std::string& text);
// The same, in bold or italic.
std::string bold(const std::string& text);
std::string italic(const std::string& text);

}  // namespace tact::manual
