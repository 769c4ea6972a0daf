#include "tests/emu/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "ipc/base/error.hpp"

namespace tact::emu {

namespace {

constexpr double kSecondsMax = 1e6;

constexpr std::array kCount{NumberRange{"N", 1, 100'000}};
constexpr std::array kMilliseconds{NumberRange{"MS", 1, 600'000}};
constexpr std::array kJoint{NumberRange{"ENCODER", 0, 5}};
constexpr std::array kJump{NumberRange{"ENCODER", 0, 5}, NumberRange{"COUNTS", -10'000'000, 10'000'000}};
constexpr std::array kContact{NumberRange{"CONTACT", 0, 1}};
constexpr std::array kButtons{NumberRange{"BITS", 0, 255}};
constexpr std::array kHandPlace{NumberRange{"X_MM", -500, 500}, NumberRange{"Y_MM", -500, 500},
                                NumberRange{"Z_MM", -500, 500}};
constexpr std::array kSensorPlace{NumberRange{"X_MM", -5000, 5000}, NumberRange{"Y_MM", -5000, 5000},
                                  NumberRange{"Z_MM", -5000, 5000}};
constexpr std::span<const NumberRange> kNone{};

constexpr std::array kActions{
    ActionRow{"plug", Action::plug, Part::arm, kNone, "", "connects the arm to the bus"},
    ActionRow{"unplug", Action::unplug, Part::arm, kNone, "", "disconnects the arm from the bus"},
    ActionRow{"stall", Action::stall, Part::arm, kNone, "", "halts its IN endpoint until the host clears it"},
    ActionRow{"silence", Action::silence, Part::arm, kMilliseconds, "ms", "neither sends nor receives"},
    ActionRow{"corrupt", Action::corrupt, Part::arm, kCount, "", "flips a bit in the next N states"},
    ActionRow{"repeat", Action::repeat, Part::arm, kCount, "", "sends the next N states twice"},
    ActionRow{"reorder", Action::reorder, Part::arm, kCount, "",
              "swaps each of the next N states with its successor"},
    ActionRow{"drop", Action::drop, Part::arm, kCount, "", "drops the next N states"},
    ActionRow{"brown-out", Action::brown_out, Part::arm, kNone, "", "supply voltage low, until well"},
    ActionRow{"hot", Action::hot, Part::arm, kNone, "", "over-temperature, until well"},
    ActionRow{"over-current", Action::over_current, Part::arm, kNone, "", "over-current, until well"},
    ActionRow{"safety open", Action::safety_open, Part::arm, kNone, "",
              "opens the safety chain at the board, until well"},
    ActionRow{"count lost", Action::count_lost, Part::arm, kNone, "", "an encoder lost counts, until well"},
    ActionRow{"encoder stuck", Action::encoder_stuck, Part::arm, kJoint, "",
              "constant count of an encoder, until well"},
    ActionRow{"encoder jump", Action::encoder_jump, Part::arm, kJump, "",
              "adds counts to an encoder, until well"},
    ActionRow{"drive dead", Action::drive_dead, Part::arm, kJoint, "", "no current in a motor, until well"},
    ActionRow{"deaf", Action::deaf, Part::arm, kNone, "", "receives no commands but still sends, until well"},
    ActionRow{"restart", Action::restart, Part::arm, kNone, "", "power cycle"},
    ActionRow{"press", Action::press, Part::arm, kButtons, "", "buttons held from now on, as bits"},
    ActionRow{"calibrate", Action::calibrate, Part::arm, kNone, "", "repeats the calibration ritual"},
    ActionRow{"hand hold", Action::hand_hold, Part::arm, kHandPlace, "",
              "moves the hand to a position in the arm's frame, where it rests"},
    ActionRow{"hand free", Action::hand_free, Part::arm, kNone, "", "the hand continues as before"},
    ActionRow{"well", Action::well, Part::arm, kNone, "", "ends all persistent faults"},
    ActionRow{"tracker silent", Action::tracker_silent, Part::tracker, kNone, "", "no frames"},
    ActionRow{"tracker corrupt", Action::tracker_corrupt, Part::tracker, kNone, "",
              "flips a bit in each frame"},
    ActionRow{"tracker nan", Action::tracker_nan, Part::tracker, kNone, "", "poses are not a number"},
    ActionRow{"tracker out-of-range", Action::tracker_out_of_range, Part::tracker, kNone, "",
              "the pose jumps out of reach"},
    ActionRow{"tracker flood", Action::tracker_flood, Part::tracker, kNone, "",
              "as many frames as a bus can carry"},
    ActionRow{"tracker hold", Action::tracker_hold, Part::tracker, kSensorPlace, "",
              "a hand holds sensor 0 at a position in the tracker's frame"},
    ActionRow{"tracker free", Action::tracker_free, Part::tracker, kNone, "",
              "sensor 0 is on the head again"},
    ActionRow{"tracker well", Action::tracker_well, Part::tracker, kNone, "",
              "ends all tracker faults and bus-off"},
    ActionRow{"can bus-off", Action::bus_off, Part::tracker, kNone, "", "sends an error frame, then nothing"},
    ActionRow{"can down", Action::link_down, Part::tracker, kNone, "", "sets the interface down"},
    ActionRow{"can up", Action::link_up, Part::tracker, kNone, "", "sets the interface up"},
    ActionRow{"lines plug", Action::lines_plug, Part::lines, kNone, "", "plugs in the adapter"},
    ActionRow{"lines unplug", Action::lines_unplug, Part::lines, kNone, "", "unplugs the adapter"},
    ActionRow{"lines stop", Action::lines_stop, Part::lines, kNone, "", "presses the emergency stop"},
    ActionRow{"lines contact", Action::lines_contact, Part::lines, kContact, "",
              "opens one contact of the emergency stop"},
    ActionRow{"lines pedal", Action::lines_pedal, Part::lines, kNone, "", "releases the dead-man pedal"},
    ActionRow{"lines well", Action::lines_well, Part::lines, kNone, "", "closes all contacts"},
    ActionRow{"status", Action::status, Part::all, kNone, "", "reports the counters of every part"},
    ActionRow{"leave", Action::leave, Part::all, kNone, "", "ends the program"},
};

constexpr bool is_space(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t i = 0;
    while (i < line.size()) {
        while (i < line.size() && is_space(line[i])) ++i;
        const std::size_t begin = i;
        while (i < line.size() && !is_space(line[i])) ++i;
        if (i > begin) words.push_back(line.substr(begin, i - begin));
    }
    return words;
}

// For messages: only printable characters.
std::string shown(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 60)) out += c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 60 ? out + "..." : out;
}

template <class Number>
std::optional<Number> number_of(std::string_view word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

std::string usage(const ActionRow& row) {
    std::string text = row.words;
    for (const NumberRange& n : row.numbers) text += std::string(" ") + n.name;
    if (row.part == Part::arm) text += " [ARM]";
    return text;
}

// The words not yet consumed.
class Words {
public:
    explicit Words(std::vector<std::string_view> all) : all_(std::move(all)) {}
    [[nodiscard]] bool empty() const { return next_ == all_.size(); }
    [[nodiscard]] std::string_view front() const { return empty() ? std::string_view{} : all_[next_]; }
    void pop() { ++next_; }
    // Consumes all the words of `text`, or none.
    bool take(std::string_view text) {
        const auto wanted = words_of(text);
        if (wanted.size() > all_.size() - next_) return false;
        if (!std::equal(wanted.begin(), wanted.end(), all_.begin() + static_cast<std::ptrdiff_t>(next_)))
            return false;
        next_ += wanted.size();
        return true;
    }

private:
    std::vector<std::string_view> all_;
    std::size_t next_ = 0;
};

std::optional<Duration> take_time(Words& words, const std::string& where) {
    if (!words.take("at")) return std::nullopt;
    std::string_view word = words.front();
    if (!word.empty() && word.back() == 's') word.remove_suffix(1);
    const auto seconds = number_of<double>(word);
    // This form also rejects NaN.
    if (!seconds || !(*seconds >= 0.0 && *seconds <= kSecondsMax))
        throw StartupError(where, "\"at\" needs a time, but \"" + shown(words.front()) + "\" follows",
                           "write for example: at 3.2 s unplug");
    words.pop();
    static_cast<void>(words.take("s"));
    return Duration(static_cast<std::int64_t>(std::llround(*seconds * 1e9)));
}

Order read_rest(const ActionRow& row, Words& words, const std::string& where) {
    Order order;
    order.action = row.action;
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
        const NumberRange& range = row.numbers[i];
        const auto value = number_of<int>(words.front());
        if (!value || *value < range.low || *value > range.high)
            throw StartupError(where,
                               std::string(range.name) + " is \"" + shown(words.front()) + "\" instead of " +
                                   std::to_string(range.low) + " to " + std::to_string(range.high),
                               "write: " + usage(row));
        order.numbers.at(i) = *value;
        words.pop();
    }
    if (*row.unit != 0) static_cast<void>(words.take(row.unit));
    if (row.part == Part::arm && !words.empty()) {
        if (!is_serial(words.front()))
            throw StartupError(where, "\"" + shown(words.front()) + "\" cannot be the serial of an arm",
                               "give an arm's serial, or none");
        order.arm = words.front();
        words.pop();
    }
    if (!words.empty())
        throw StartupError(where, "too many words: \"" + shown(words.front()) + "\"", "write: " + usage(row));
    return order;
}

}  // namespace

std::span<const ActionRow> actions() { return kActions; }

const ActionRow& row_of(Action action) {
    return *std::find_if(kActions.begin(), kActions.end(),
                         [action](const ActionRow& r) { return r.action == action; });
}

bool is_serial(std::string_view text) noexcept {
    return !text.empty() && text.size() <= 16 && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
               c == '_';
    });
}

std::optional<Order> parse_order(std::string_view line, const std::string& where) {
    line = line.substr(0, line.find('#'));
    if (line.size() > kLineMax)
        throw StartupError(where, "the line is longer than " + std::to_string(kLineMax) + " characters",
                           "write one order per line");
    Words words(words_of(line));
    if (words.empty()) return std::nullopt;
    const auto at = take_time(words, where);
    for (const ActionRow& row : kActions) {
        if (!words.take(row.words)) continue;
        Order order = read_rest(row, words, where);
        order.at = at;
        return order;
    }
    std::string known;
    for (const ActionRow& row : kActions) known += (known.empty() ? "" : "; ") + usage(row);
    throw StartupError(where, "unknown order \"" + shown(line) + "\"", "orders: " + known);
}

std::vector<Order> parse_script(std::string_view text, const std::string& where) {
    std::vector<Order> orders;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string line = where + ", line " + std::to_string(++number);
        if (auto order = parse_order(text.substr(0, end), line)) {
            if (orders.size() == kOrdersMax)
                throw StartupError(line, "more than " + std::to_string(kOrdersMax) + " orders",
                                   "split the file");
            orders.push_back(std::move(*order));
        }
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    }
    std::stable_sort(orders.begin(), orders.end(),
                     [](const Order& a, const Order& b) { return a.at < b.at; });
    return orders;
}

std::vector<Order> read_script(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw StartupError("fault file " + path, "it cannot be opened", "check the path and its rights");
    std::string text(kScriptBytesMax + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (file.bad() || text.size() > kScriptBytesMax)
        throw StartupError("fault file " + path,
                           "it is not a text of at most " + std::to_string(kScriptBytesMax) + " bytes",
                           "give a fault file (tact-emu --help lists the orders)");
    return parse_script(text, path);
}

}  // namespace tact::emu
