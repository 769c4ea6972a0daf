#include "gui/drilling/training/training_report.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "gui/drilling/training/training_text.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array kColumns{"date",    "trainee",     "task",       "scene",       "points", "goal",
                              "outside", "thin",        "structures", "force",       "sight",  "time",
                              "time_s",  "removed_mm3", "injuries",   "force_max_n", "strokes"};
constexpr std::size_t kTrainee = 1, kTask = 2;
constexpr std::uintmax_t kTableMost = 64U << 20U;

// What a spreadsheet takes as text, whatever is in it.
std::string plain(std::string cell) {
    if (!cell.empty() && std::strchr("=+-@\t", cell[0]) != nullptr) cell.insert(cell.begin(), '\'');
    return cell;
}

std::string csv(const std::string& text) {
    std::string cell = plain(text);
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string out = "\"";
    for (const char c : cell) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

// The next row of a table; false at its end.
bool read_row(std::istream& in, std::vector<std::string>& row) {
    row.assign(1, {});
    bool quoted = false;
    int c = in.get();
    if (c == EOF) return false;
    for (; c != EOF; c = in.get()) {
        const char sign = static_cast<char>(c);
        if (quoted) {
            if (sign != '"')
                row.back() += sign;
            else if (in.peek() == '"')
                row.back() += static_cast<char>(in.get());
            else
                quoted = false;
        } else if (sign == '"') {
            quoted = true;
        } else if (sign == ',') {
            row.emplace_back();
        } else if (sign == '\n') {
            break;
        } else {
            row.back() += sign;
        }
    }
    return true;
}

std::vector<std::string> row_of(const TrainingSession& s) {
    std::vector<std::string> row{s.date, csv(s.trainee), csv(s.plan->title), csv(s.scene),
                                 rounded(s.score.total, 1)};
    for (std::size_t part = 0; part < kTrainingPartNames.size(); ++part) {
        std::string points;
        for (const TrainingPoints& p : s.score.part)
            if (static_cast<std::size_t>(p.part) == part) points = rounded(p.points, 2);
        row.push_back(points);
    }
    const json force = s.performance.value("force", json::object()),
               strokes = s.performance.value("strokes", json::object());
    row.push_back(rounded(s.score.time_s, 1));
    row.push_back(rounded(number(s.performance, "removed_mm3"), 2));
    row.push_back(rounded(number(s.performance, "injuries"), 0));
    row.push_back(rounded(number(force, "max_n"), 3));
    row.push_back(rounded(number(strokes, "count"), 0));
    return row;
}

std::string joined(const std::vector<std::string>& row) {
    std::string line;
    for (const std::string& cell : row) line += (line.empty() ? "" : ",") + cell;
    return line + "\n";
}

}  // namespace

json training_json(const TrainingSession& s) {
    json parts = json::object(), items = json::array();
    for (const TrainingPoints& p : s.score.part)
        parts[kTrainingPartNames[static_cast<std::size_t>(p.part)]] = {{"points", p.points}, {"of", p.of}};
    for (const TrainingItem& i : s.score.item)
        items.push_back({{"name", i.name}, {"state", state_name(i.state)}, {"value", i.value}});
    return {{"task", s.plan->title},    {"trainee", s.trainee},
            {"scene", s.scene},         {"date", s.date},
            {"points", s.score.total},  {"parts", parts},
            {"checklist", items},       {"work_share", s.score.work},
            {"time_s", s.score.time_s}, {"performance", s.performance}};
}

void append_training_row(const fs::path& table, const TrainingSession& session) {
    const auto fail = [&table](int why) {
        throw StartupError("appending to the table of training sessions " + table.string(),
                           std::strerror(why), "make the file writable, or move it away");
    };
    const int fd = ::open(table.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (fd < 0) fail(errno);
    std::string text;
    if (::lseek(fd, 0, SEEK_END) == 0) {
        for (const char* const column : kColumns) text += (text.empty() ? "" : ",") + std::string(column);
        text += "\n";
    }
    text += joined(row_of(session));
    const ssize_t written = ::write(fd, text.data(), text.size());
    const int why = written < 0 ? errno : ENOSPC;
    ::close(fd);
    if (written != static_cast<ssize_t>(text.size())) fail(why);
}

std::vector<std::vector<std::string>> read_training_table(const fs::path& table, const std::string& trainee,
                                                          const std::string& title) {
    std::vector<std::vector<std::string>> rows;
    std::error_code none;
    const auto bytes = fs::file_size(table, none);
    if (none || bytes > kTableMost) return rows;
    std::ifstream in(table, std::ios::binary);
    std::vector<std::string> row;
    while (read_row(in, row))
        if (row.size() == kColumns.size() && row[kTrainee] == plain(trainee) && row[kTask] == plain(title))
            rows.push_back(row);
    return rows;
}

fs::path write_training(const fs::path& folder, const TrainingSession& session) {
    std::string name = session.date;
    for (char& c : name)
        if (c == ' ' || c == ':') c = '-';
    fs::path own = folder / name;
    std::error_code failed;
    for (int i = 2; fs::exists(own, failed); ++i) own = folder / (name + "-" + std::to_string(i));
    fs::create_directories(own, failed);
    if (failed)
        throw StartupError("making the folder " + own.string(), failed.message(),
                           "give a writable folder: --training-folder");
    const fs::path table = folder / "training.csv";
    const auto earlier = read_training_table(table, session.trainee, session.plan->title);
    write_whole_file(own / "report.json",
                     training_json(session).dump(2, ' ', false, json::error_handler_t::replace) + "\n");
    write_whole_file(own / "report.html", training_page(session, earlier));
    append_training_row(table, session);
    return own / "report.html";
}

}  // namespace tact
