#include "hal/openhaptics/hd_library.hpp"

#include "hal/probe/known_devices.hpp"

namespace tact::hd {

namespace {

constexpr vendor::LibraryTexts kHdTexts{
    "the haptic library libHD.so",
    "install the manufacturer's OpenHaptics and device driver for Linux, or set device.hd_library to the "
    "file",
    "set device.hd_library to the libHD.so of OpenHaptics 3.4 or newer"};

}  // namespace

Library::Library(const std::string& path) : library_(path, probe::kHdPlaces, kHdTexts) {
#define TACT_HD_FIND(type, name, arguments) library_.require(#name, api_.name);
    TACT_HD_FUNCTIONS(TACT_HD_FIND)
#undef TACT_HD_FIND
}

}  // namespace tact::hd
