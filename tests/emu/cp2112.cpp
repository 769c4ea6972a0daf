#include "tests/emu/cp2112.hpp"

#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "ipc/base/error.hpp"

namespace tact::emu {

namespace {

enum Report : std::uint8_t { kGpioConfig = 2, kGpioGet = 3, kGpioSet = 4, kVersion = 5, kSmbusConfig = 6 };

struct ReportShape {
    std::uint8_t number, bytes, kind;  // kind: 0xB1 feature, 0x81 input, 0x91 output
};
constexpr std::array<ReportShape, 8> kShapes{{{kGpioConfig, 4, 0xB1},
                                              {kGpioGet, 1, 0xB1},
                                              {kGpioSet, 2, 0xB1},
                                              {kVersion, 2, 0xB1},
                                              {kSmbusConfig, 13, 0xB1},
                                              {0x20, 1, 0xB1},
                                              {0x13, 63, 0x81},
                                              {0x10, 63, 0x91}}};

std::vector<std::uint8_t> descriptor() {
    std::vector<std::uint8_t> d{0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01,
                                0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08};
    for (const ReportShape& s : kShapes)
        d.insert(d.end(), {0x85, s.number, 0x95, s.bytes, 0x09, 0x01, s.kind, 0x02});
    d.push_back(0xC0);
    return d;
}

}  // namespace

std::uint8_t Cp2112::pins() const {
    unsigned pins = (latch_ & outputs_) | (outside_ & ~outputs_);
    for (unsigned line = 0; line < kLines; ++line) {
        if (follows_[line] < 0 || is_output(line)) continue;
        const auto from = static_cast<unsigned>(follows_[line]);
        const bool high = (latch_ & outputs_ & (1U << from)) != 0;
        pins = high ? pins | 1U << line : pins & ~(1U << line);
    }
    return static_cast<std::uint8_t>(pins);
}

std::vector<std::uint8_t> Cp2112::get_report(std::uint8_t number) const {
    switch (number) {
        case kGpioConfig:
            return {number, outputs_, 0xFF, 0, 0};  // push-pull
        case kGpioGet:
            return {number, pins()};
        case kVersion:
            return {number, 0x0C, 2};
        case kSmbusConfig: {
            std::vector<std::uint8_t> config(14);
            config[0] = number;
            config[4] = 0x64;
            return config;
        }
        default:
            return {number, 0};
    }
}

void Cp2112::set_report(std::span<const std::uint8_t> bytes) {
    const unsigned before = latch_ & outputs_;
    if (bytes.size() >= 2 && bytes[0] == kGpioConfig) outputs_ = bytes[1];
    if (bytes.size() >= 3 && bytes[0] == kGpioSet)
        latch_ = static_cast<std::uint8_t>((latch_ & ~bytes[2]) | (bytes[1] & bytes[2]));
    const unsigned moved = before ^ (latch_ & outputs_);
    for (unsigned line = 0; line < kLines; ++line) edges_[line] += moved >> line & 1U;
}

void Cp2112::set(unsigned line, bool level) {
    const unsigned bit = line < kLines ? 1U << line : 0U;
    outside_ = static_cast<std::uint8_t>(level ? outside_ | bit : outside_ & ~bit);
}

void Cp2112::follow(unsigned input, unsigned output) {
    if (input < kLines && output < kLines) follows_[input] = static_cast<int>(output);
}

bool Cp2112::level(unsigned line) const { return line < kLines && (pins() >> line & 1U) != 0; }

bool Cp2112::is_output(unsigned line) const { return line < kLines && (outputs_ >> line & 1U) != 0; }

void EmulatedLines::plug() {
    unplug();
    fd_ = open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd_ < 0) {
        throw StartupError("plugging in an emulated CP2112 through /dev/uhid", std::strerror(errno),
                           "run as root on a kernel with the module uhid, such as that of tests/hil");
    }
    {
        const std::lock_guard lock(mutex_);
        Cp2112 fresh = chip_;
        fresh.set_report(std::array<std::uint8_t, 2>{kGpioConfig, 0});
        fresh.set_report(std::array<std::uint8_t, 3>{kGpioSet, 0, 0xFF});
        chip_ = fresh;
    }
    const auto event = std::make_unique<uhid_event>();
    event->type = UHID_CREATE2;
    uhid_create2_req& request = event->u.create2;
    std::memcpy(request.name, "tact CP2112", sizeof "tact CP2112");
    const std::vector<std::uint8_t> d = descriptor();
    std::copy(d.begin(), d.end(), request.rd_data);
    request.rd_size = static_cast<std::uint16_t>(d.size());
    request.bus = BUS_USB;
    request.vendor = 0x10C4;
    request.product = 0xEA90;
    if (write(fd_, event.get(), sizeof *event) < 0) {
        const std::string why = std::strerror(errno);
        ::close(fd_);
        fd_ = -1;
        throw StartupError("plugging in an emulated CP2112 through /dev/uhid", why,
                           "load the module hid-cp2112");
    }
    leave_fd_ = eventfd(0, EFD_CLOEXEC);
    thread_ = std::thread([this] { serve(); });
}

void EmulatedLines::unplug() {
    if (fd_ < 0) return;
    uhid_event event{};
    event.type = UHID_DESTROY;
    static_cast<void>(!write(fd_, &event, sizeof event));
    const std::uint64_t one = 1;
    static_cast<void>(!write(leave_fd_, &one, sizeof one));
    thread_.join();
    ::close(fd_);
    ::close(leave_fd_);
    fd_ = leave_fd_ = -1;
}

void EmulatedLines::serve() {
    const auto in = std::make_unique<uhid_event>(), out = std::make_unique<uhid_event>();
    for (;;) {
        std::array<pollfd, 2> wait{pollfd{fd_, POLLIN, 0}, pollfd{leave_fd_, POLLIN, 0}};
        if (::poll(wait.data(), wait.size(), -1) < 0 && errno != EINTR) return;
        if (wait[1].revents != 0) return;
        if ((wait[0].revents & POLLIN) == 0 || read(fd_, in.get(), sizeof *in) < 0) continue;
        const std::lock_guard lock(mutex_);
        *out = {};
        if (in->type == UHID_GET_REPORT) {
            const std::vector<std::uint8_t> data = chip_.get_report(in->u.get_report.rnum);
            out->type = UHID_GET_REPORT_REPLY;
            out->u.get_report_reply.id = in->u.get_report.id;
            out->u.get_report_reply.size = static_cast<std::uint16_t>(data.size());
            std::copy(data.begin(), data.end(), out->u.get_report_reply.data);
        } else if (in->type == UHID_SET_REPORT) {
            const uhid_set_report_req& r = in->u.set_report;
            const Cp2112 before = chip_;
            chip_.set_report(std::span(r.data).first(std::min<std::size_t>(r.size, sizeof r.data)));
            for (unsigned line = 0; tell_ && line < Cp2112::kLines; ++line) {
                if (chip_.edges(line) != before.edges(line)) tell_(line, chip_.level(line));
            }
            out->type = UHID_SET_REPORT_REPLY;
            out->u.set_report_reply.id = r.id;
        } else {
            continue;
        }
        static_cast<void>(!write(fd_, out.get(), sizeof *out));
    }
}

void EmulatedLines::set(unsigned line, bool level) {
    const std::lock_guard lock(mutex_);
    chip_.set(line, level);
}

void EmulatedLines::follow(unsigned input, unsigned output) {
    const std::lock_guard lock(mutex_);
    chip_.follow(input, output);
}

bool EmulatedLines::level(unsigned line) {
    const std::lock_guard lock(mutex_);
    return chip_.level(line);
}

std::uint64_t EmulatedLines::edges(unsigned line) {
    const std::lock_guard lock(mutex_);
    return chip_.edges(line);
}

}  // namespace tact::emu
