#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "gui/stereo/stage_file.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

constexpr std::size_t kRemarksMost = 64, kRemarkMost = 200;

// Nine decimals: nanometres, and less than a pixel for any quaternion.
std::string number(double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%.9f", value);
    std::string out = text;
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out += '0';
    return out == "-0.0" ? "0.0" : out;
}

std::string list(const auto& values) {
    std::string out;
    for (const double v : values) out += (out.empty() ? "" : ", ") + number(v);
    return "[" + out + "]";
}

// One comment line: a remark may contain foreign text.
std::string remark(const std::string& text) {
    std::string out = "# ";
    for (const char c : text.substr(0, kRemarkMost)) out += c >= ' ' && c <= '~' ? c : ' ';
    return out + "\n";
}

std::string moment_text() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y%m%dT%H%M%SZ", &utc)};
}

// Keeps the old file under a second name as well, so that a stage file exists at any time.
std::filesystem::path keep_old(const std::filesystem::path& path, const auto& fail) {
    const std::string stem = path.string() + "." + moment_text();
    for (int i = 0; i < 100; ++i) {
        const std::string kept = stem + (i == 0 ? "" : "-" + std::to_string(i)) + ".old";
        if (::link(path.c_str(), kept.c_str()) == 0) return kept;
        if (errno == ENOENT) return {};
        if (errno == EEXIST) continue;
        // A file system without hard links.
        std::error_code error;
        if (std::filesystem::copy_file(path, kept, error)) return kept;
        fail("the old file cannot be kept: " + error.message());
    }
    fail("a hundred old files of this second exist already");
    return {};
}

}  // namespace

std::string stage_text(const StageSettings& s, std::span<const std::string> remarks) {
    std::string out;
    for (const std::string& each : remarks.first(std::min(remarks.size(), kRemarksMost))) out += remark(each);
    out += "mode = \"" + std::string(stereo_mode_text(s.mode)) + "\"\n";
    std::string monitors;
    for (const int m : s.monitors) monitors += (monitors.empty() ? "" : ", ") + std::to_string(m);
    out += "monitors = [" + monitors + "]\n";
    out += "size_px = [" + std::to_string(s.width_px) + ", " + std::to_string(s.height_px) + "]\n";
    out += std::string("place = \"") + (s.in_workspace ? "workspace" : "orbit") + "\"\n";
    out += "latency_ms = " + number(1e3 * s.latency_s) + "\n";
    const auto vector = [&](const char* key, const Vec3& v) {
        out += std::string(key) + " = " + list(std::span<const double>(v.data(), 3)) + "\n";
    };
    if (s.screen_measured) {
        out += "\n[screen]\n";
        vector("lower_left_m", s.screen.lower_left_m);
        vector("lower_right_m", s.screen.lower_right_m);
        vector("upper_left_m", s.screen.upper_left_m);
    }
    out += "\n[eyes]\napart_m = " + number(s.eyes.apart_m) + "\n";
    out += std::string("swapped = ") + (s.eyes.swapped ? "true" : "false") + "\n";
    vector("middle_head_m", s.eyes.middle_head_m);
    vector("rest_screen_m", s.rest_screen_m);
    out += "\n[workspace]\n";
    vector("position_screen_m", s.T_screen_world.p_m);
    out +=
        "quat_screen_world_xyzw = " + list(std::span<const double>(s.T_screen_world.q.coeffs().data(), 4)) +
        "\n";
    out += "\n[wand]\n";
    vector("tip_sensor_m", s.wand_tip_sensor_m);
    return out;
}

std::filesystem::path write_stage_file(const std::filesystem::path& path, const StageSettings& settings,
                                       std::span<const std::string> remarks) {
    const std::string text = stage_text(settings, remarks);
    // A text that cannot be read back is no stage: rejected before anything is written.
    static_cast<void>(read_stage_text(text, path.string()));
    const auto fail = [&](const std::string& why) {
        throw StartupError("writing the stage file '" + path.string() + "'", why,
                           "choose an existing, writable folder with free space (--stage FILE)");
    };
    std::error_code error;
    if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), error))
        fail("the folder " + path.parent_path().string() + " does not exist");
    std::filesystem::path old = keep_old(path, fail);
    try {
        write_whole_file(path, text);
    } catch (const StartupError&) {
        if (!old.empty()) std::filesystem::remove(old, error);  // the stage file itself is unchanged
        throw;
    }
    return old;
}

// Both are read, because a quaternion of rounded numbers is normalized, which may change its last digit.
bool is_in_stage_file(const StageSettings& settings, const std::filesystem::path& path) {
    const StageSettings meant = read_stage_text(stage_text(settings), path.string());
    return stage_text(read_stage_file(path)) == stage_text(meant);
}

}  // namespace tact
