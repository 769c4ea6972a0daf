#include "tests/emu/report.hpp"

#include <array>
#include <cstdio>

namespace tact::emu {

namespace {

// For JSON without escapes: replaces special and non-ASCII characters by '?'.
std::string plain(const std::string& text) {
    std::string out;
    for (const char c : text) out += c >= ' ' && c <= '~' && c != '"' && c != '\\' ? c : '?';
    return out;
}

std::string for_people(const ReportLine& l, std::initializer_list<ReportNumber> numbers) {
    std::array<char, 32> time{};
    std::snprintf(time.data(), time.size(), "%.6f", to_s(l.at.time_since_epoch()));
    std::string text = std::string(time.data()) + " " + l.part;
    if (!l.name.empty()) text += " " + plain(l.name);
    text += std::string(": ") + l.what + " " + plain(l.detail);
    const char* before = " (";
    for (const ReportNumber& n : numbers) {
        text += before + std::string(n.name) + " " + std::to_string(n.value);
        before = ", ";
    }
    return text + (numbers.size() > 0 ? ")\n" : "\n");
}

std::string as_json(const ReportLine& l, std::initializer_list<ReportNumber> numbers) {
    std::string text = "{\"t_ns\": " + std::to_string(to_ns(l.at));
    const auto add = [&text](const char* key, const std::string& value) {
        text += std::string(", \"") + key + "\": \"" + plain(value) + "\"";
    };
    add("part", l.part);
    add("name", l.name);
    add("what", l.what);
    add("detail", l.detail);
    for (const ReportNumber& n : numbers)
        text += std::string(", \"") + n.name + "\": " + std::to_string(n.value);
    return text + "}\n";
}

}  // namespace

std::string line_text(const ReportLine& line, std::initializer_list<ReportNumber> numbers, bool json) {
    return json ? as_json(line, numbers) : for_people(line, numbers);
}

void Report::say(const ReportLine& line, std::initializer_list<ReportNumber> numbers) noexcept {
    const std::string text = line_text(line, numbers, json_);
    const std::lock_guard lock(mutex_);
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

}  // namespace tact::emu
