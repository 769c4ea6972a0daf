// The fixes for missing rights: the one place that has these texts. tact doctor tells which of them applies.
#pragma once

namespace tact {

// Not a member of the group, or the files are not installed. The package brings the files, so that only the membership lacks.
inline constexpr const char* kRightsFix =
    "sudo deploy/install.sh --rights (with the package: sudo usermod -aG tact,realtime $USER); log in again";
// The same where a device's node may not be opened: udev applies its rules when the device is plugged in.
inline constexpr const char* kDeviceRightsFix =
    "sudo deploy/install.sh --rights (with the package: sudo usermod -aG tact,realtime $USER); log in "
    "again, and plug the device in again";
// A member, but this session began before that.
inline constexpr const char* kLoginFix = "log out of the whole session and in again (or restart the machine)";
// All is installed, but nothing applied it to this session.
inline constexpr const char* kSessionLimitsFix =
    "log in again; if that does not help, add \"session required pam_limits.so\" to "
    "/etc/pam.d/common-session; in a systemd service set LimitRTPRIO=95 and LimitMEMLOCK=infinity instead";
// Root in a container.
inline constexpr const char* kCapabilityFix =
    "run outside the container, or give it --cap-add SYS_NICE --cap-add IPC_LOCK";
// From the controller itself, which does not look into the matter.
inline constexpr const char* kLimitsFix =
    "tact doctor tells what is missing; usually: sudo deploy/install.sh --rights (with the package: sudo "
    "usermod -aG tact,realtime $USER); log in again";

}  // namespace tact
