#include "hal/vendor/shared_library.hpp"

#include <dlfcn.h>

#include "ipc/base/error.hpp"

namespace tact::vendor {

namespace {

void* load_shared(const char* path, std::string& why) {
    dlerror();
    void* const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (handle != nullptr) return handle;
    const char* const words = dlerror();
    why += std::string(why.empty() ? "" : "; ") + (words != nullptr ? words : path);
    return nullptr;
}

}  // namespace

SharedLibrary::SharedLibrary(const std::string& path, std::span<const char* const> places,
                             const LibraryTexts& texts)
    : texts_(texts), path_(path) {
    std::string why;
    if (!path.empty()) {
        handle_ = load_shared(path.c_str(), why);
    } else {
        for (const char* const place : places) {
            handle_ = load_shared(place, why);
            path_ = place;
            if (handle_ != nullptr) break;
        }
    }
    if (handle_ == nullptr)
        throw StartupError(std::string("loading ") + texts_.name + (path.empty() ? "" : " from " + path), why,
                           texts_.fix_missing);
}

SharedLibrary::~SharedLibrary() { dlclose(handle_); }

void* SharedLibrary::symbol(const char* name) const noexcept { return dlsym(handle_, name); }

void SharedLibrary::refuse(const char* name) const {
    throw StartupError(std::string(texts_.name) + " at " + path_,
                       std::string("the library has no function ") + name, texts_.fix_old);
}

}  // namespace tact::vendor
