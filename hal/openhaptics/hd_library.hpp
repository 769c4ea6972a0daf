// The vendor's library, found and loaded at run time; nothing of it is needed to build Tact.
//
// Fails by StartupError: not found (with every place that was looked in), not loadable (with the loader's
//          words), or another library of that name (with the function that it lacks)
// Thread   start-up; unloaded by the destructor, when nothing of it runs any more
#pragma once

#include <string>

#include "hal/openhaptics/hd_api.hpp"

namespace tact::hd {

class Library {
public:
    explicit Library(const std::string& path);  // empty: where the vendor's installers and links put it
    ~Library();
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    [[nodiscard]] const Api& api() const noexcept { return api_; }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    void* handle_ = nullptr;
    std::string path_;
    Api api_;
};

}  // namespace tact::hd
