#include "tests/emu/gadget.hpp"

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "ipc/base/error.hpp"
#include "tests/emu/usb_descriptors.hpp"

namespace tact::emu {

namespace {

constexpr const char* kGadgets = "/sys/kernel/config/usb_gadget";
constexpr const char* kControllers = "/sys/class/udc";
constexpr const char* kMounts = "/run/tact-emu";
constexpr const char* kModules = "modprobe libcomposite usb_f_fs, and modprobe dummy_hcd num=2 (as root)";

// Writes a file of the kernel; returns its error, 0 for none.
int put(const std::string& path, const std::string& text) noexcept {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0) return errno;
    const bool good = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    const int error = good ? 0 : errno;
    ::close(fd);
    return error;
}

[[noreturn]] void refuse(const std::string& what, int error, const std::string& fix) {
    throw StartupError("emulated arm on USB: " + what, std::strerror(error),
                       error == EACCES || error == EPERM ? "run tact-emu as root" : fix);
}

void need_put(const std::string& path, const std::string& text) {
    if (const int error = put(path, text)) refuse(path, error, kModules);
}

void need_folder(const std::string& path) {
    if (::mkdir(path.c_str(), 0755) != 0 && errno != EEXIST) refuse(path, errno, kModules);
}

void need_write(int fd, const std::vector<std::byte>& bytes, const char* what) {
    if (::write(fd, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        refuse(what, errno, "use a kernel of 5.4 or newer");
}

int need_open(const std::string& path, int flags) {
    const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
    if (fd < 0) refuse(path, errno, kModules);
    return fd;
}

// Emulated controllers only: a real one would connect this device to whatever is plugged in there.
std::vector<std::string> controllers() {
    std::vector<std::string> found;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(kControllers, none)) {
        const std::string name = entry.path().filename();
        if (name.starts_with("dummy_udc")) found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

Gadget::Gadget(const std::string& serial, const std::string& product, std::uint16_t rate_hz)
    : serial_(serial),
      folder_(std::string(kGadgets) + "/tact-emu-" + serial),
      mount_point_(std::string(kMounts) + "/" + serial) {
    if (::access(kGadgets, F_OK) != 0)
        throw StartupError("emulated arm on USB", "this kernel has no USB gadget support loaded",
                           std::string(kModules) + "; mount -t configfs none /sys/kernel/config");
    if (controllers().empty())
        throw StartupError("emulated arm on USB", "there is no emulated USB controller",
                           "modprobe dummy_hcd num=2 (as root)");
    remove();
    try {
        build(product, rate_hz);
    } catch (...) {
        remove();
        throw;
    }
}

Gadget::~Gadget() { remove(); }

void Gadget::build(const std::string& product, std::uint16_t rate_hz) {
    const std::string function = folder_ + "/functions/ffs." + serial_;
    for (const char* sub : {"", "/strings/0x409", "/configs/c.1"}) need_folder(folder_ + sub);
    need_folder(function);
    need_put(folder_ + "/idVendor", "0x1209");  // pid.codes, for prototypes
    need_put(folder_ + "/idProduct", "0x0001");
    need_put(folder_ + "/strings/0x409/manufacturer", "Tact");
    need_put(folder_ + "/strings/0x409/product", product);
    need_put(folder_ + "/strings/0x409/serialnumber", serial_);
    if (::symlink(function.c_str(), (folder_ + "/configs/c.1/ffs." + serial_).c_str()) != 0)
        refuse(function, errno, kModules);
    need_folder(kMounts);
    need_folder(mount_point_);
    if (::mount(serial_.c_str(), mount_point_.c_str(), "functionfs", 0, nullptr) != 0)
        refuse("mounting functionfs at " + mount_point_, errno, kModules);
    control_ = need_open(mount_point_ + "/ep0", O_RDWR);
    need_write(control_, ffs_descriptors(rate_hz), "descriptors");
    need_write(control_, ffs_strings(), "strings");
    // O_NONBLOCK: open does not wait for the host. Transfers block nevertheless.
    to_host_ = need_open(mount_point_ + "/ep1", O_RDWR | O_NONBLOCK);
    from_host_ = need_open(mount_point_ + "/ep2", O_RDWR | O_NONBLOCK);
}

void Gadget::plug() {
    if (plugged_) return;
    int error = ENODEV;
    for (const std::string& name : controller_.empty() ? controllers() : std::vector{controller_}) {
        error = put(folder_ + "/UDC", name);
        if (error != 0) continue;
        controller_ = name;
        plugged_ = true;
        return;
    }
    refuse("plugging " + serial_, error,
           "every dummy_udc is in use: modprobe -r dummy_hcd, then load it with num=4");
}

void Gadget::unplug() noexcept {
    if (!plugged_) return;
    static_cast<void>(put(folder_ + "/UDC", "\n"));
    plugged_ = false;
}

// Any step may find nothing to remove.
void Gadget::remove() noexcept {
    plugged_ = false;
    static_cast<void>(put(folder_ + "/UDC", "\n"));
    for (int* fd : {&from_host_, &to_host_, &control_}) {
        if (*fd >= 0) ::close(*fd);
        *fd = -1;
    }
    ::unlink((folder_ + "/configs/c.1/ffs." + serial_).c_str());
    for (const std::string sub : {"/configs/c.1", "/strings/0x409"}) ::rmdir((folder_ + sub).c_str());
    ::umount2(mount_point_.c_str(), MNT_DETACH);
    ::rmdir((folder_ + "/functions/ffs." + serial_).c_str());
    ::rmdir(folder_.c_str());
    ::rmdir(mount_point_.c_str());
    ::rmdir(kMounts);  // fails while another arm is mounted
}

}  // namespace tact::emu
