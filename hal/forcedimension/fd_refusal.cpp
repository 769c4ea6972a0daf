#include "hal/forcedimension/fd_refusal.hpp"

#include "ipc/base/error.hpp"

namespace tact::fd {

namespace {

// The library's text, in printable ASCII.
std::string library_text(const Api& api, int code) {
    std::string out;
    const char* const text = api.dhdErrorGetLastStr();
    for (const char* c = text; c != nullptr && *c != '\0' && out.size() < 80; ++c)
        out += *c >= ' ' && *c <= '~' ? *c : '?';
    return (out.empty() ? "no text" : out) + " (error " + std::to_string(code) + " of the library)";
}

std::string connected(const OpenResult& result) {
    std::string list;
    for (std::size_t i = 0; i < result.free; ++i)
        list += (list.empty() ? "" : ", ") + std::to_string(result.serials[i]);
    return list.empty() ? "" : "; serial numbers: " + list;
}

}  // namespace

void refuse_open(const OpenResult& result, const Api& api, const std::string& serial) {
    const std::string what =
        "opening the Force Dimension device" + (serial.empty() ? "" : " with serial number " + serial);
    switch (result.failure) {
        case OpenFailure::missing:
            if (result.count == 0)
                throw StartupError(
                    what, "the library finds no device",
                    "plug in its USB cable, switch it on, and run sudo deploy/install.sh --rights "
                    "for access to it; tact probe lists what is connected");
            throw StartupError(what, "no free device with this serial number" + connected(result),
                               "correct device.serial, or end the program that uses the device");
        case OpenFailure::several:
            throw StartupError(what, "several devices are connected" + connected(result),
                               "set device.serial in the configuration to the one to use");
        case OpenFailure::unknown_model:
            throw StartupError(
                what, "Tact knows no limits for this model (type " + std::to_string(result.type) + ")",
                "use an omega.3, .6 or .7, delta.3, sigma.3 or .7, lambda.3 or .7; for a Novint Falcon set "
                "device.driver = \"falcon\"");
        case OpenFailure::not_initialized:
            throw StartupError(what, meaning(FaultKind::not_initialized).says,
                               meaning(FaultKind::not_initialized).fixes);
        case OpenFailure::no_robot_library:
            throw StartupError(what, "the device is not initialized, and libdhd cannot initialize it",
                               "set device.fd_library to libdrd.so of the same SDK, or run HapticInit of the "
                               "Force Dimension SDK");
        case OpenFailure::moved_wrongly:
            throw StartupError(what, "the initialization failed: " + library_text(api, result.code),
                               "let go of the arm, clear its workspace, press its force button, and start "
                               "again; or run HapticInit of the Force Dimension SDK");
        default:
            break;
    }
    const FaultKind kind = fault_of_error(result.code);
    throw StartupError(
        what, std::string(meaning(kind).says) + ": " + library_text(api, result.code),
        kind == FaultKind::link
            ? "check its USB cable and power supply, and run sudo deploy/install.sh --rights for "
              "access to it"
            : meaning(kind).fixes);
}

}  // namespace tact::fd
