// A manufacturer's shared library, loaded at run time; the build of Tact needs none of them.
//
// Errors   StartupError: not found (with the loader's message of every place), or a missing function
// Thread   start-up; the destructor unloads the library, after none of its code runs any more
#pragma once

#include <span>
#include <string>

namespace tact::vendor {

struct LibraryTexts {
    const char* name;         // "the haptic library libHD.so"
    const char* fix_missing;  // where to get it, and the configuration key
    const char* fix_old;      // version required
};

class SharedLibrary {
public:
    // path: of the file; empty: the first of `places` that loads.
    SharedLibrary(const std::string& path, std::span<const char* const> places, const LibraryTexts& texts);
    ~SharedLibrary();
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    template <class Function>
    void require(const char* name, Function& out) const {
        if (!find(name, out)) refuse(name);
    }
    template <class Function>
    [[nodiscard]] bool find(const char* name, Function& out) const noexcept {
        // POSIX returns functions as pointers to data.
        out = reinterpret_cast<Function>(symbol(name));
        return out != nullptr;
    }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    [[nodiscard]] void* symbol(const char* name) const noexcept;
    [[noreturn]] void refuse(const char* name) const;

    LibraryTexts texts_;
    std::string path_;
    void* handle_ = nullptr;
};

}  // namespace tact::vendor
