#include "hal/forcedimension/fd_library.hpp"

#include "hal/probe/known_devices.hpp"
#include "ipc/base/error.hpp"

namespace tact::fd {

namespace {

constexpr const char* kFdFixOld =
    "install the Force Dimension SDK 3.7 or newer for 64-bit Linux (forcedimension.com, Support, Downloads) "
    "and set device.fd_library to its libdrd.so";
constexpr vendor::LibraryTexts kFdTexts{
    "the haptic library libdrd.so or libdhd.so",
    "install the Force Dimension SDK for 64-bit Linux (forcedimension.com, Support, Downloads), and set "
    "device.fd_library to the libdrd.so in its folder lib/release/lin-x86_64-gcc; or copy that file to "
    "/usr/local/lib and run sudo ldconfig",
    kFdFixOld};
constexpr int kMajorMin = 3, kMinorMin = 7;

}  // namespace

Library::Library(const std::string& path) : library_(path, probe::kFdPlaces, kFdTexts) {
#define TACT_FD_REQUIRE(type, name, arguments) library_.require(#name, api_.name);
    TACT_FD_FUNCTIONS(TACT_FD_REQUIRE)
#undef TACT_FD_REQUIRE
    api_.robot = true;
#define TACT_FD_FIND(type, name, arguments) api_.robot = library_.find(#name, api_.name) && api_.robot;
    TACT_FD_ROBOT_FUNCTIONS(TACT_FD_FIND)
#undef TACT_FD_FIND
    int major = 0, minor = 0, release = 0, revision = 0;
    api_.dhdGetSDKVersion(&major, &minor, &release, &revision);
    version_ = std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
    // A later major version may have other argument types.
    if (major != kMajorMin || minor < kMinorMin)
        throw StartupError("the haptic library at " + library_.path(),
                           "its version is " + version_ + ", and Tact supports 3.7 and later versions 3",
                           kFdFixOld);
}

}  // namespace tact::fd
