// libgpiod 2.x: one request for all lines, each with its own settings.
#include <gpiod.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <vector>

#include "hal/io/gpio_access.hpp"

namespace tact {

namespace {

constexpr const char* kConsumer = "tact-rt";
constexpr std::size_t kEvents = 16;  // per poll; the rest waits for the next one

template <auto kFree>
struct Free {
    template <class T>
    void operator()(T* p) const {
        kFree(p);
    }
};
template <class T, auto kFree>
using Owned = std::unique_ptr<T, Free<kFree>>;

using Chip = Owned<gpiod_chip, &gpiod_chip_close>;

// The offset, or -1.
int find_line(gpiod_chip* chip, const std::string& line) {
    unsigned number = 0;
    if (!gpio_line_number(line, number)) return gpiod_chip_get_line_offset_from_name(chip, line.c_str());
    const Owned<gpiod_chip_info, &gpiod_chip_info_free> info(gpiod_chip_get_info(chip));
    return info && number < gpiod_chip_info_get_num_lines(info.get()) ? static_cast<int>(number) : -1;
}

std::string owner_of(gpiod_chip* chip, unsigned offset) {
    const Owned<gpiod_line_info, &gpiod_line_info_free> info(gpiod_chip_get_line_info(chip, offset));
    const char* const owner = info ? gpiod_line_info_get_consumer(info.get()) : nullptr;
    return owner == nullptr ? "" : owner;
}

void set_up(gpiod_line_settings* s, const GpioLine& request) {
    bool ok = gpiod_line_settings_set_direction(
                  s, request.output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT) == 0;
    gpiod_line_settings_set_active_low(s, request.active_low);
    if (request.output) ok = ok && gpiod_line_settings_set_output_value(s, GPIOD_LINE_VALUE_INACTIVE) == 0;
    if (request.edges && !request.output)
        ok = ok && gpiod_line_settings_set_edge_detection(s, GPIOD_LINE_EDGE_BOTH) == 0;
    if (request.bias == GpioBias::up)
        ok = ok && gpiod_line_settings_set_bias(s, GPIOD_LINE_BIAS_PULL_UP) == 0;
    if (request.bias == GpioBias::down)
        ok = ok && gpiod_line_settings_set_bias(s, GPIOD_LINE_BIAS_PULL_DOWN) == 0;
    if (!ok) throw GpioRefusal{.line = request.line, .error = errno, .detail = "its settings"};
}

}  // namespace

struct GpioAccess::Library {
    struct Row {
        unsigned offset = 0;
        bool output = false;
    };
    Chip chip;
    std::vector<Row> rows;
    bool edges = false;
    Owned<gpiod_line_request, &gpiod_line_request_release> request;
    Owned<gpiod_edge_event_buffer, &gpiod_edge_event_buffer_free> events;
};

GpioAccess::GpioAccess(const std::string& path, std::span<const GpioLine> lines)
    : library_(std::make_unique<Library>()) {
    Library& l = *library_;
    l.chip.reset(gpiod_chip_open(path.c_str()));
    if (!l.chip) throw GpioRefusal{.error = errno, .detail = path};
    const Owned<gpiod_line_config, &gpiod_line_config_free> config(gpiod_line_config_new());
    const Owned<gpiod_request_config, &gpiod_request_config_free> request(gpiod_request_config_new());
    const Owned<gpiod_line_settings, &gpiod_line_settings_free> settings(gpiod_line_settings_new());
    l.events.reset(gpiod_edge_event_buffer_new(kEvents));
    if (!config || !request || !settings || !l.events) throw GpioRefusal{.error = ENOMEM, .detail = path};
    gpiod_request_config_set_consumer(request.get(), kConsumer);
    for (const GpioLine& line : lines.first(std::min(lines.size(), kLinesMax))) {
        const int found = find_line(l.chip.get(), line.line);
        if (found < 0) throw GpioRefusal{.line = line.line};
        const auto offset = static_cast<unsigned>(found);
        gpiod_line_settings_reset(settings.get());
        set_up(settings.get(), line);
        if (gpiod_line_config_add_line_settings(config.get(), &offset, 1, settings.get()) != 0)
            throw GpioRefusal{.line = line.line, .error = errno, .detail = "its settings"};
        l.rows.push_back({.offset = offset, .output = line.output});
        l.edges = l.edges || (line.edges && !line.output);
    }
    l.request.reset(gpiod_chip_request_lines(l.chip.get(), request.get(), config.get()));
    if (l.request) return;
    const int error = errno;
    for (std::size_t i = 0; i < l.rows.size(); ++i) {
        const std::string owner = owner_of(l.chip.get(), l.rows[i].offset);
        if (!owner.empty()) throw GpioRefusal{.line = lines[i].line, .error = error, .detail = owner};
    }
    throw GpioRefusal{.error = error, .detail = path};
}

GpioAccess::~GpioAccess() = default;

bool GpioAccess::get(std::uint32_t& active) noexcept {
    std::uint32_t values = 0;
    for (std::size_t i = 0; i < library_->rows.size(); ++i) {
        if (library_->rows[i].output) continue;
        const gpiod_line_value v =
            gpiod_line_request_get_value(library_->request.get(), library_->rows[i].offset);
        if (v == GPIOD_LINE_VALUE_ERROR) return false;
        if (v == GPIOD_LINE_VALUE_ACTIVE) values |= 1U << i;
    }
    active = values;
    return true;
}

bool GpioAccess::set(std::size_t i, bool active) noexcept {
    return i < library_->rows.size() &&
           gpiod_line_request_set_value(library_->request.get(), library_->rows[i].offset,
                                        active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
}

bool GpioAccess::wait(Duration longest, std::uint32_t& touched) noexcept {
    Library& l = *library_;
    if (!l.edges) {
        const timespec time{.tv_sec = longest.count() / 1'000'000'000,
                            .tv_nsec = longest.count() % 1'000'000'000};
        nanosleep(&time, nullptr);
        return true;
    }
    const int ready = gpiod_line_request_wait_edge_events(l.request.get(), longest.count());
    if (ready <= 0) return ready == 0 || errno == EINTR;
    const int count = gpiod_line_request_read_edge_events(l.request.get(), l.events.get(), kEvents);
    if (count < 0) return false;
    for (int n = 0; n < count; ++n) {
        gpiod_edge_event* const event =
            gpiod_edge_event_buffer_get_event(l.events.get(), static_cast<unsigned long>(n));
        const unsigned offset = gpiod_edge_event_get_line_offset(event);
        for (std::size_t i = 0; i < l.rows.size(); ++i) {
            if (l.rows[i].offset == offset) touched |= 1U << i;
        }
    }
    return true;
}

bool GpioAccess::describe(const std::string& path, GpioChip& chip, int& error) {
    const Chip c(gpiod_chip_open(path.c_str()));
    const Owned<gpiod_chip_info, &gpiod_chip_info_free> info(c ? gpiod_chip_get_info(c.get()) : nullptr);
    if (!info) {
        error = errno;
        return false;
    }
    chip = {.path = path,
            .name = gpiod_chip_info_get_name(info.get()),
            .label = gpiod_chip_info_get_label(info.get()),
            .lines = static_cast<unsigned>(gpiod_chip_info_get_num_lines(info.get()))};
    return true;
}

}  // namespace tact
