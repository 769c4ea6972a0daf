// The vendor's library, found and loaded at run time; the build of Tact needs none of it.
//
// Errors   StartupError: not found (with every place searched), not loadable (with the loader's message),
//          or another library of that name (with the missing function)
// Thread   start-up; the destructor unloads the library when none of its code runs any more
#pragma once

#include <string>

#include "hal/openhaptics/hd_api.hpp"
#include "hal/vendor/shared_library.hpp"

namespace tact::hd {

class Library {
public:
    explicit Library(const std::string& path);  // empty: searches the places used by the vendor's installers

    [[nodiscard]] const Api& api() const noexcept { return api_; }
    [[nodiscard]] const std::string& path() const noexcept { return library_.path(); }

private:
    vendor::SharedLibrary library_;
    Api api_;
};

}  // namespace tact::hd
