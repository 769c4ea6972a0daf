// All fix texts for missing rights. tact doctor determines the one that applies.
#pragma once

namespace tact {

// Not a member of the group, or files not installed; the package installs the files.
inline constexpr const char* kRightsFix =
    "sudo deploy/install.sh --rights (with the package: sudo usermod -aG tact,realtime $USER); log in again";
// The same for a device node without access: udev applies its rules when the device is plugged in.
inline constexpr const char* kDeviceRightsFix =
    "sudo deploy/install.sh --rights (with the package: sudo usermod -aG tact,realtime $USER); log in "
    "again, and plug the device in again";
// A member, but since after the start of this session.
inline constexpr const char* kLoginFix = "log out of the whole session and in again (or restart the machine)";
// Everything is installed, but not applied to this session.
inline constexpr const char* kSessionLimitsFix =
    "log in again; if that does not help, add \"session required pam_limits.so\" to "
    "/etc/pam.d/common-session; in a systemd service set LimitRTPRIO=95 and LimitMEMLOCK=infinity instead";
// Root in a container.
inline constexpr const char* kCapabilityFix =
    "run outside the container, or give it --cap-add SYS_NICE --cap-add IPC_LOCK";
// From the controller itself, which does not analyse the cause.
inline constexpr const char* kLimitsFix =
    "run tact doctor to find the missing right; usually: sudo deploy/install.sh --rights (with the package: "
    "sudo "
    "usermod -aG tact,realtime $USER); log in again";

}  // namespace tact
