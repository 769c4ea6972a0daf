#include "hal/openhaptics/hd_library.hpp"

#include <dlfcn.h>

#include "hal/probe/known_devices.hpp"
#include "ipc/base/error.hpp"

namespace tact::hd {

namespace {

constexpr const char* kFix =
    "install the manufacturer's OpenHaptics and device driver for Linux, or set device.hd_library to the "
    "file";

void* load(const char* path, std::string& why) {
    dlerror();
    void* const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (handle != nullptr) return handle;
    const char* const words = dlerror();
    why += std::string(why.empty() ? "" : "; ") + (words != nullptr ? words : path);
    return nullptr;
}

template <class Function>
void find(void* handle, const std::string& path, const char* name, Function& out) {
    // POSIX returns functions as pointers to data.
    out = reinterpret_cast<Function>(dlsym(handle, name));
    if (out == nullptr) {
        throw StartupError("the haptic library " + path, std::string("the library has no function ") + name,
                           "set device.hd_library to the libHD.so of OpenHaptics 3.4 or newer");
    }
}

}  // namespace

Library::Library(const std::string& path) : path_(path) {
    std::string why;
    if (!path.empty()) {
        handle_ = load(path.c_str(), why);
    } else {
        for (const char* const place : probe::kHdPlaces) {
            handle_ = load(place, why);
            path_ = place;
            if (handle_ != nullptr) break;
        }
    }
    if (handle_ == nullptr)
        throw StartupError("loading the haptic library libHD.so" + (path.empty() ? "" : " from " + path), why,
                           kFix);
    try {
#define TACT_HD_FIND(type, name, arguments) find(handle_, path_, #name, api_.name);
        TACT_HD_FUNCTIONS(TACT_HD_FIND)
#undef TACT_HD_FIND
    } catch (...) {
        dlclose(handle_);
        throw;
    }
}

Library::~Library() { dlclose(handle_); }

}  // namespace tact::hd
