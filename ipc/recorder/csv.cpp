#include "ipc/recorder/csv.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/record/recording_reader.hpp"
#include "ipc/topics/text.hpp"

namespace tact::record {
namespace {

class Row {
public:
    template <class T>
    void number(T value) {
        std::array<char, 40> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
        comma();
        line_.append(text.data(), end);
    }
    void numbers(const double* values, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) number(values[i]);
    }
    void text(const std::string& value) {
        comma();
        line_ += value;
    }
    const std::string& end() { return line_ += '\n'; }
    void clear() { line_.clear(); }

private:
    void comma() {
        if (!line_.empty()) line_ += ',';
    }
    std::string line_;
};

std::string header(std::uint32_t hands) {
    Row row;
    for (const char* const name : {"time_s", "cycle", "state", "level", "lateness_us", "cost_us", "model_us"})
        row.text(name);
    for (std::uint32_t i = 0; i < hands; ++i) {
        const std::string hand = "hand" + std::to_string(i) + "_";
        for (const char* const name :
             {"x_m",        "y_m",          "z_m",          "qx",           "qy",
              "qz",         "qw",           "fx_n",         "fy_n",         "fz_n",
              "tx_n_m",     "ty_n_m",       "tz_n_m",       "model_fx_n",   "model_fy_n",
              "model_fz_n", "model_tx_n_m", "model_ty_n_m", "model_tz_n_m", "buttons"})
            row.text(hand + name);
    }
    return row.end();
}

const std::string& row_of(Row& row, const RecordedStep& s, std::uint32_t hands, std::int64_t begin_ns) {
    row.clear();
    const CycleTopic& c = s.cycle;
    const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
    row.number(static_cast<double>(c.now_ns - begin_ns) * 1e-9);
    row.number(c.cycle);
    row.text(run_state_text(static_cast<RunState>(c.run_state)));
    row.number(c.level);
    row.number(us(c.lateness_ns));
    row.number(us(c.cost_ns));
    row.number(us(c.model_ns));
    for (std::uint32_t i = 0; i < hands; ++i) {
        const HandRow& h = s.hand[i];
        row.numbers(h.pos_world_m, 3);
        row.numbers(h.quat_world_tool_xyzw, 4);
        row.numbers(h.t.force_world_n, 3);
        row.numbers(h.t.torque_world_n_m, 3);
        row.numbers(h.t.force_model_world_n, 3);
        row.numbers(h.t.torque_model_world_n_m, 3);
        row.number(h.t.buttons);
    }
    return row.end();
}

}  // namespace

std::uint64_t write_csv(const CsvSettings& settings, const std::function<bool()>& stop) {
    if (std::filesystem::exists(settings.file))
        throw StartupError("writing '" + settings.file.string() + "'", "the file exists already",
                           "choose another file, or remove it");
    RecordingReader reader(settings.recording);
    const std::uint32_t hands = reader.about().start.hands;
    std::ofstream out(settings.file, std::ios::binary);
    const auto give_up = [&](const std::string& why, const char* fix) {
        out.close();
        std::error_code gone;
        std::filesystem::remove(settings.file, gone);
        throw StartupError("writing '" + settings.file.string() + "'", why, fix);
    };
    out << header(hands);
    Row row;
    RecordedStep step;
    std::uint64_t rows = 0, seen = 0;
    std::optional<std::int64_t> begin_ns;
    try {
        while (out && reader.next(step)) {
            if ((step.cycle.flags & kCycleDry) != 0) continue;
            if (!begin_ns) begin_ns = step.cycle.now_ns;
            if (seen++ % settings.every != 0) continue;
            out << row_of(row, step, hands, *begin_ns);
            ++rows;
            if (rows % 1024 == 0 && stop()) give_up("stopped", "start the conversion again");
        }
    } catch (const RecordError& e) {
        give_up(e.what(), "the recording is not readable beyond this point");
    }
    out.close();
    if (!out) give_up("the disk is full", "free disk space, or write fewer rows with --every");
    return rows;
}

}  // namespace tact::record
