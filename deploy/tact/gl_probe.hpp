// Queries the OpenGL version of this machine without a window.
#pragma once

#include <string>

namespace tact::launch {

struct GlAnswer {
    std::string renderer;  // "llvmpipe (LLVM 15.0.6, 256 bits)"; "": none
    std::string why;       // reason if there is none
    [[nodiscard]] bool software() const;
};

// Runs in a process of its own with a time limit, because graphics drivers may hang or crash.
GlAnswer probe_gl();

}  // namespace tact::launch
