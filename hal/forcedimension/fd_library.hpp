// The Force Dimension SDK's library, found and loaded at run time; the build of Tact needs none of it.
//
// Places   libdrd before libdhd: it contains libdhd, and the functions that initialize an arm
// Errors   StartupError: not found (with every place searched), not loadable (with the loader's message),
//          an older SDK (with the missing function), a version older than 3.7 (with both versions)
// Thread   start-up
#pragma once

#include <string>

#include "hal/forcedimension/fd_api.hpp"
#include "hal/vendor/shared_library.hpp"

namespace tact::fd {

class Library {
public:
    explicit Library(const std::string& path);  // empty: searches

    [[nodiscard]] const Api& api() const noexcept { return api_; }
    [[nodiscard]] const std::string& path() const noexcept { return library_.path(); }
    [[nodiscard]] const std::string& version() const noexcept { return version_; }  // "3.17.6"

private:
    vendor::SharedLibrary library_;
    std::string version_;
    Api api_;
};

}  // namespace tact::fd
