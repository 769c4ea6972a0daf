// Parses faults and their times: the lines of a fault file, or of standard input.
//
// Line     [at SECONDS [s]] ACTION [NUMBERS] [ARM]; # begins a comment; kActions lists every action
// Arm      by its serial; without one: every arm
// Hostile  a line of any bytes: bounded, every number checked against its row
// Fails by StartupError with the file, the line and the valid forms
// Thread   any
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact::emu {

enum class Action : std::uint8_t {
    plug,
    unplug,
    stall,
    silence,
    corrupt,
    repeat,
    reorder,
    drop,
    brown_out,
    hot,
    over_current,
    safety_open,
    count_lost,
    encoder_stuck,
    encoder_jump,
    drive_dead,
    deaf,
    restart,
    press,
    calibrate,
    hand_hold,
    hand_free,
    well,
    tracker_silent,
    tracker_corrupt,
    tracker_nan,
    tracker_out_of_range,
    tracker_flood,
    tracker_hold,
    tracker_free,
    tracker_well,
    bus_off,
    link_down,
    link_up,
    lines_plug,
    lines_unplug,
    lines_stop,
    lines_contact,
    lines_pedal,
    lines_well,
    status,
    leave,
};

enum class Part : std::uint8_t { arm, tracker, lines, all };

struct NumberRange {
    const char* name;
    int low, high;
};

struct ActionRow {
    const char* words;
    Action action;
    Part part;
    std::span<const NumberRange> numbers;
    const char* unit;  // optional after the numbers
    const char* what;
};
[[nodiscard]] std::span<const ActionRow> actions();
[[nodiscard]] const ActionRow& row_of(Action action);

struct Order {
    std::optional<Duration> at;  // after the start; none: immediately
    Action action = Action::status;
    std::array<int, 3> numbers{};
    std::string arm;  // empty: every arm
    bool operator==(const Order&) const = default;
};

inline constexpr std::size_t kOrdersMax = 10'000, kLineMax = 200;
inline constexpr std::size_t kScriptBytesMax = kOrdersMax * 100;

// none: an empty line or a comment. `where` starts the error message.
[[nodiscard]] std::optional<Order> parse_order(std::string_view line, const std::string& where);
// Returns orders sorted by time; those without a time come first.
[[nodiscard]] std::vector<Order> parse_script(std::string_view text, const std::string& where);
[[nodiscard]] std::vector<Order> read_script(const std::string& path);

// A serial becomes the name of folders and of a USB string: 1 to 16 letters, digits, '-' and '_'.
[[nodiscard]] bool is_serial(std::string_view text) noexcept;

}  // namespace tact::emu
