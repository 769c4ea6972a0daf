// Why an arm could not be opened, with the fix.
#pragma once

#include <string>

#include "hal/forcedimension/fd_session.hpp"

namespace tact::fd {

// Throws StartupError. serial: as configured. On the thread that tried to open: the library keeps the text of
// its error per thread.
[[noreturn]] void refuse_open(const OpenResult& result, const Api& api, const std::string& serial);

}  // namespace tact::fd
