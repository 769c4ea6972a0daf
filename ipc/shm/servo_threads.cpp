#include "ipc/shm/servo_threads.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <system_error>

#include "ipc/shm/session_path.hpp"

namespace tact {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTextMax = 16384;

std::string small_text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text(kTextMax, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    return text;
}

// The number if it is the whole text, otherwise -1.
int whole_number(const std::string& text) {
    int value = -1;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && at == end && value >= 0 ? value : -1;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// The core of "Cpus_allowed_list:\t3"; -1: several or none.
int only_core(const std::string& status) {
    constexpr const char* kKey = "\nCpus_allowed_list:";
    const auto at = status.find(kKey);
    if (at == std::string::npos) return -1;
    const auto begin = status.find_first_not_of(" \t", at + std::char_traits<char>::length(kKey));
    return begin == std::string::npos ? -1 : whole_number(first_line(status.substr(begin)));
}

// Session in a command line with a zero after each argument.
std::string session_of(const std::string& command_line) {
    std::string session = "default";
    bool next = false;
    for (std::size_t at = 0; at < command_line.size();) {
        const auto end = std::min(command_line.find('\0', at), command_line.size());
        const std::string word = command_line.substr(at, end - at);
        if (next) session = word;
        next = word == "--session";
        if (word.rfind("--session=", 0) == 0) session = word.substr(10);
        at = end + 1;
    }
    return is_session_name(session) ? session : "?";
}

// Calls each(number, folder) for every folder whose name is a number.
template <class F>
void for_numbers(const fs::path& folder, F each) {
    std::error_code gone;
    fs::directory_iterator i(folder, gone);
    for (; !gone && i != fs::directory_iterator(); i.increment(gone))
        if (const int number = whole_number(i->path().filename().string()); number >= 0)
            each(number, i->path());
}

std::string text_of(const PinnedServo& s) {
    return "session " + s.session + " (process " + std::to_string(s.process) + ")";
}

std::string joined(const std::vector<std::string>& parts) {
    std::string all;
    for (const std::string& p : parts) all += (all.empty() ? "" : ", ") + p;
    return all;
}

}  // namespace

std::vector<PinnedServo> pinned_servos(const fs::path& proc) {
    std::vector<PinnedServo> found;
    for_numbers(proc, [&](int process, const fs::path& folder) {
        if (first_line(small_text(folder / "comm")) != "tact-rt") return;
        for_numbers(folder / "task", [&](int, const fs::path& task) {
            if (first_line(small_text(task / "comm")) != "servo") return;
            if (const int core = only_core(small_text(task / "status")); core >= 0)
                found.push_back({process, core, session_of(small_text(folder / "cmdline"))});
        });
    });
    std::sort(found.begin(), found.end(),
              [](const PinnedServo& a, const PinnedServo& b) { return a.process < b.process; });
    return found;
}

std::string shared_core_text(const std::vector<PinnedServo>& servos, int own_process) {
    const auto own = std::find_if(servos.begin(), servos.end(),
                                  [&](const PinnedServo& s) { return s.process == own_process; });
    if (own == servos.end()) return "";
    std::vector<std::string> others;
    for (const PinnedServo& s : servos)
        if (s.process != own_process && s.core == own->core) others.push_back(text_of(s));
    if (others.empty()) return "";
    return "core " + std::to_string(own->core) + " is also the core of " + joined(others) +
           ": the force loops delay each other";
}

std::string shared_cores_text(const std::vector<PinnedServo>& servos) {
    std::map<int, std::vector<std::string>> by_core;
    for (const PinnedServo& s : servos) by_core[s.core].push_back(text_of(s));
    std::string all;
    for (const auto& [core, sessions] : by_core)
        if (sessions.size() > 1)
            all += (all.empty() ? "" : "; ") + std::string("core ") + std::to_string(core) +
                   " is shared by " + joined(sessions);
    return all;
}

}  // namespace tact
