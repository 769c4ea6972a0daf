// A raw SocketCAN socket: the tracker's frames only, taken with recvmmsg into fixed arrays.
//
// Kernel   filters let through the configured tracker's identifiers and nothing else; error frames on;
//          frames that found no room are counted (SO_RXQ_OVFL); the queue holds about one round of the
//          reader
// Thread   one; receive() does not allocate
// Fails by open(): StartupError naming the interface and the command that fixes it. Later by CanFault.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <vector>

#include "hal/tracker/can_source.hpp"
#include "hal/tracker/fix_assembler.hpp"

namespace tact {

// Exactly the frames of so many sensors; extended identifiers and remote requests never pass.
[[nodiscard]] std::vector<can_filter> tracker_filters(CanFormat format, unsigned sensors);

// Why an interface cannot be read, and the fix; `error` is the errno of the step.
enum class CanStep : std::uint8_t { socket, interface, type, state, mtu, option, bind };
[[noreturn]] void refuse_interface(CanStep step, const std::string& interface, int error);

class SocketCan final : public CanSource {
public:
    SocketCan(std::string interface, const FixSettings& settings);
    // On a socket that is open already and gives one CAN frame a message, as a raw CAN socket does. It is
    // closed with this object and cannot be reopened.
    explicit SocketCan(int fd);
    ~SocketCan() override;
    SocketCan(const SocketCan&) = delete;
    SocketCan& operator=(const SocketCan&) = delete;

    void open() override;
    bool reopen() noexcept override;
    CanBatch receive(std::span<CanFrame> into, Duration patience) noexcept override;

private:
    struct Control {
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint32_t))> bytes;
    };
    void close() noexcept;
    [[nodiscard]] CanBatch fault(int error, CanBatch batch) noexcept;

    std::string interface_;
    FixSettings settings_;
    int fd_ = -1;
    std::uint32_t dropped_ = 0;  // the kernel's running count
    std::array<canfd_frame, kCanBatch> raw_{};
    std::array<iovec, kCanBatch> parts_{};
    std::array<mmsghdr, kCanBatch> messages_{};
    std::array<Control, kCanBatch> controls_{};
};

}  // namespace tact
