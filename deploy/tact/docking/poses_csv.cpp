#include "deploy/tact/docking/poses_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr std::string_view kHeader = "t_s,x_m,y_m,z_m,qx,qy,qz,qw";
constexpr std::array<const char*, 8> kColumns{"t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
constexpr std::size_t kLineMax = 1024;

[[noreturn]] void fail(const std::string& name, std::size_t line, const std::string& why,
                       const std::string& fix) {
    throw StartupError("reading the poses in '" + name + "', line " + std::to_string(line), why, fix);
}

// Limits the text of a malicious file in messages to a few printable characters.
std::string shown(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 24)) out += c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 24 ? out + "…" : out;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

TimedPose parse(std::string_view text, const std::string& name, std::size_t line) {
    std::array<double, 8> value{};
    for (std::size_t column = 0; column < value.size(); ++column) {
        const std::size_t comma = text.find(',');
        const bool last = column + 1 == value.size();
        if ((comma == std::string_view::npos) != last) {
            fail(name, line, "the line does not have eight columns",
                 "write " + std::string(kHeader) + " on every line");
        }
        const std::string_view field = trimmed(text.substr(0, comma));
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value[column]);
        if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value[column])) {
            fail(name, line,
                 std::string(kColumns[column]) + " is '" + shown(field) + "', not a finite number",
                 "write numbers as 0.0125 or 1.25e-2");
        }
        if (!last) text.remove_prefix(comma + 1);
    }
    const Quat q(value[7], value[4], value[5], value[6]);
    if (!(q.norm() > 0.9 && q.norm() < 1.1)) {
        fail(name, line,
             "the quaternion qx,qy,qz,qw has length " + std::to_string(q.norm()) + " instead of 1",
             "write the rotation as a unit quaternion with the real part last");
    }
    return {value[0], Pose{Vec3(value[1], value[2], value[3]), q.normalized()}};
}

}  // namespace

std::vector<TimedPose> read_poses_csv(std::istream& in, const std::string& name) {
    std::vector<TimedPose> poses;
    std::array<char, kLineMax> buffer{};
    bool header = false;
    for (std::size_t line = 1;; ++line) {
        in.getline(buffer.data(), buffer.size());
        const auto got = static_cast<std::size_t>(in.gcount());
        if (in.fail() && got + 1 >= buffer.size()) {
            fail(name, line, "the line is longer than " + std::to_string(kLineMax - 1) + " characters",
                 "write one pose per line");
        }
        if (in.bad()) fail(name, line, "the file cannot be read", "check the disk and the permissions");
        if (in.fail()) break;
        // getline counts the newline; the last line has none.
        std::string_view text(buffer.data(), in.eof() ? got : got - 1);
        if (line == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
        text = trimmed(text);
        if (text.empty() || text.front() == '#') continue;
        if (!header) {
            if (text != kHeader) {
                fail(name, line, "the line is '" + shown(text) + "' instead of the header",
                     "begin the file with " + std::string(kHeader));
            }
            header = true;
            continue;
        }
        if (poses.size() == kPosesMax) {
            fail(name, line, "the file has more than " + std::to_string(kPosesMax) + " poses",
                 "split the file");
        }
        poses.push_back(parse(text, name, line));
    }
    if (poses.empty()) {
        throw StartupError("reading the poses in '" + name + "'", "the file has no poses",
                           "write " + std::string(kHeader) + " and then one line per pose");
    }
    return poses;
}

std::vector<TimedPose> read_poses_csv(const std::filesystem::path& path) {
    std::error_code error;
    const bool folder = std::filesystem::is_directory(path, error);
    std::ifstream in(path, std::ios::binary);
    if (!in || folder) {
        throw StartupError("reading the poses in '" + path.string() + "'", "the file cannot be opened",
                           "check that the file exists and is readable");
    }
    return read_poses_csv(in, path.string());
}

}  // namespace tact::launch
