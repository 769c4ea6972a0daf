// A raw SocketCAN socket: receives the tracker's frames only, with recvmmsg into fixed arrays.
//
// Kernel   filters pass only the identifiers of the configured tracker; error frames are on; frames dropped
//          for lack of space are counted (SO_RXQ_OVFL); the queue holds about one round of the reader
// Thread   one; receive() does not allocate
// Errors   open(): StartupError with the interface and the command that fixes it; later a CanFault
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <vector>

#include "hal/tracker/can_source.hpp"
#include "hal/tracker/fix_assembler.hpp"

namespace tact {

// Passes exactly the frames of this many sensors; extended identifiers and remote requests never pass.
[[nodiscard]] std::vector<can_filter> tracker_filters(CanFormat format, unsigned sensors);

// Steps of opening an interface; refuse_interface() reports the failed one with its fix. `error`: errno.
enum class CanStep : std::uint8_t { socket, interface, type, state, mtu, option, bind };
[[noreturn]] void refuse_interface(CanStep step, const std::string& interface, int error);

class SocketCan final : public CanSource {
public:
    SocketCan(std::string interface, const FixSettings& settings);
    // With an open socket that returns one CAN frame per message, as a raw CAN socket does. This object
    // closes it and cannot reopen it.
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
