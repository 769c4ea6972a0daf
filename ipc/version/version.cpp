#include "ipc/version/version.hpp"

#include TACT_VERSION_TEXT

namespace tact {

const char* version() { return kVersionText; }

std::string program_version(const char* program) { return std::string(program) + " " + kVersionText; }

}  // namespace tact
