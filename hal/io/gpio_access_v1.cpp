// libgpiod 1.6: a separate request for each line, because level and bias are settings of a request there.
#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <vector>

#include "hal/io/gpio_access.hpp"

namespace tact {

namespace {

constexpr const char* kConsumer = "tact-rt";

struct ChipCloser {
    void operator()(gpiod_chip* c) const { gpiod_chip_close(c); }  // releases its lines too
};
using Chip = std::unique_ptr<gpiod_chip, ChipCloser>;

int flags_of(const GpioLine& l) {
    int flags = l.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    if (l.bias == GpioBias::up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    if (l.bias == GpioBias::down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    return flags;
}

gpiod_line* find_line(gpiod_chip* chip, const std::string& line) {
    unsigned number = 0;
    if (!gpio_line_number(line, number)) return gpiod_chip_find_line(chip, line.c_str());
    return number < gpiod_chip_num_lines(chip) ? gpiod_chip_get_line(chip, number) : nullptr;
}

}  // namespace

struct GpioAccess::Library {
    struct Row {
        gpiod_line* line = nullptr;
        bool output = false, edges = false;
    };
    Chip chip;
    std::vector<Row> rows;
    std::array<pollfd, kLinesMax> fds{};
    nfds_t fd_count = 0;
};

GpioAccess::GpioAccess(const std::string& path, std::span<const GpioLine> lines)
    : library_(std::make_unique<Library>()) {
    Library& l = *library_;
    l.chip.reset(gpiod_chip_open(path.c_str()));
    if (!l.chip) throw GpioRefusal{.error = errno, .detail = path};
    for (const GpioLine& request : lines.first(std::min(lines.size(), kLinesMax))) {
        gpiod_line* const line = find_line(l.chip.get(), request.line);
        if (line == nullptr) throw GpioRefusal{.line = request.line};
        const int flags = flags_of(request);
        int refused = 0;
        if (request.output) {
            refused = gpiod_line_request_output_flags(line, kConsumer, flags, 0);
        } else if (request.edges) {
            refused = gpiod_line_request_both_edges_events_flags(line, kConsumer, flags);
        } else {
            refused = gpiod_line_request_input_flags(line, kConsumer, flags);
        }
        if (refused != 0) {
            const int error = errno;
            const char* const owner = gpiod_line_consumer(line);
            throw GpioRefusal{.line = request.line, .error = error, .detail = owner == nullptr ? "" : owner};
        }
        l.rows.push_back({.line = line, .output = request.output, .edges = request.edges && !request.output});
        if (l.rows.back().edges) {
            l.fds[l.fd_count++] = {.fd = gpiod_line_event_get_fd(line), .events = POLLIN, .revents = 0};
        }
    }
}

GpioAccess::~GpioAccess() = default;

bool GpioAccess::get(std::uint32_t& active) noexcept {
    std::uint32_t values = 0;
    for (std::size_t i = 0; i < library_->rows.size(); ++i) {
        if (library_->rows[i].output) continue;
        const int value = gpiod_line_get_value(library_->rows[i].line);
        if (value < 0) return false;
        if (value > 0) values |= 1U << i;
    }
    active = values;
    return true;
}

bool GpioAccess::set(std::size_t i, bool active) noexcept {
    return i < library_->rows.size() && gpiod_line_set_value(library_->rows[i].line, active ? 1 : 0) == 0;
}

bool GpioAccess::wait(Duration longest, std::uint32_t& touched) noexcept {
    Library& l = *library_;
    const timespec time{.tv_sec = longest.count() / 1'000'000'000,
                        .tv_nsec = longest.count() % 1'000'000'000};
    const int count = ppoll(l.fds.data(), l.fd_count, &time, nullptr);
    if (count < 0) return errno == EINTR;
    std::size_t fd = 0;
    for (std::size_t i = 0; count > 0 && i < l.rows.size(); ++i) {
        if (!l.rows[i].edges) continue;
        const pollfd& p = l.fds[fd++];
        if (p.revents == 0) continue;
        if ((p.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return false;
        std::array<gpiod_line_event, 16> events{};  // the rest waits for the next poll
        if (gpiod_line_event_read_fd_multiple(p.fd, events.data(), events.size()) < 0) return false;
        touched |= 1U << i;
    }
    return true;
}

bool GpioAccess::describe(const std::string& path, GpioChip& chip, int& error) {
    const Chip c(gpiod_chip_open(path.c_str()));
    if (!c) {
        error = errno;
        return false;
    }
    chip = {.path = path,
            .name = gpiod_chip_name(c.get()),
            .label = gpiod_chip_label(c.get()),
            .lines = gpiod_chip_num_lines(c.get())};
    return true;
}

}  // namespace tact
