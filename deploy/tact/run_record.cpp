#include "deploy/tact/run_record.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "deploy/tact/system_run.hpp"
#include "ipc/topics/text.hpp"

namespace tact::launch {
namespace {

constexpr const char* kPlaced[] = {"offset_a", "angle_deg", "bone_taken_mm3"};

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

// Empty if the system has no such value.
std::string own_text(const Sample& s, std::string_view column) {
    for (const OwnValue& v : s.own) {
        if (column != v.column) continue;
        std::array<char, 48> text{};
        std::snprintf(text.data(), text.size(), "%.*f", v.decimals, v.value);
        return text.data();
    }
    return {};
}

}  // namespace

std::optional<Sample> take_sample(const RtRegion& region, const SystemRun* system, double t_s) {
    const auto health = newest(region.health);
    if (!health) return std::nullopt;
    Sample s;
    s.t_s = t_s;
    s.health = *health;
    if (const auto levels = newest(region.levels)) {
        if (const auto picture = level_at(*levels, kDisplayPathIndex)) {
            s.level_picture = picture->level;
            s.vertices_asked = picture->items;
        }
        if (const auto force = level_at(*levels, kForcePathIndex)) {
            s.level_force = force->level;
            s.points = force->items;
        }
        const auto particles = level_at(*levels, kParticlesPathIndex);
        if (particles && std::string_view(particles->path) == kParticlesPath)
            s.level_particles = particles->level;
    }
    if (system != nullptr) system->sample(region, s);
    return s;
}

std::string table_header(const Sample& s) {
    const std::string first =
        "                      force ----- lateness us -----\n"
        "  t s  state             Hz     p50     p99     max  overruns";
    return first +
           (s.particles ? "      rays   fps  level display, force, particles"
                        : "  vertices   fps  level mesh, force") +
           s.heading + "\n";
}

std::string table_row(const Sample& s) {
    std::array<char, 256> line{};
    const HealthTopic& h = s.health;
    std::snprintf(line.data(), line.size(),
                  "%5.1f  %-8.8s %10.1f %7.1f %7.1f %7.0f %9llu %9u %5.1f        %4.2f,  %4.2f", s.t_s,
                  run_state_text(static_cast<RunState>(h.state)), h.force_rate_hz, us(h.lateness_p50_ns),
                  us(h.lateness_p99_ns), us(h.lateness_max_ns), static_cast<unsigned long long>(h.overruns),
                  h.gui_vertices, h.gui_fps, s.level_picture, s.level_force);
    std::string text = line.data();
    if (s.particles) {
        std::snprintf(line.data(), line.size(), ",       %4.2f", s.level_particles);
        text += line.data();
    }
    return text + s.line_end + "\n";
}

std::string samples_csv(const std::vector<Sample>& samples) {
    // The columns of these systems keep their place in the file; columns of other systems follow at the end.
    std::vector<std::string> more;
    for (const Sample& s : samples)
        for (const OwnValue& v : s.own)
            if (std::find(std::begin(kPlaced), std::end(kPlaced), std::string_view(v.column)) ==
                    std::end(kPlaced) &&
                std::find(more.begin(), more.end(), v.column) == more.end())
                more.emplace_back(v.column);
    std::string text =
        "t_s,state,force_rate_hz,goal_hz,lateness_p50_us,lateness_p99_us,lateness_max_us,cycle_cost_p50_us,"
        "overruns,gui_fps,gui_vertices,vertices_asked,level_picture,level_force,points,offset_a,angle_deg,"
        "level_particles,bone_taken_mm3";
    for (const std::string& column : more) text += "," + column;
    text += '\n';
    for (const Sample& s : samples) {
        std::array<char, 320> line{};
        const HealthTopic& h = s.health;
        std::snprintf(line.data(), line.size(),
                      "%.3f,%s,%.2f,%.2f,%.3f,%.3f,%.3f,%.3f,%llu,%.2f,%u,%u,%.4f,%.4f,%u,", s.t_s,
                      run_state_text(static_cast<RunState>(h.state)), h.force_rate_hz, h.goal_hz,
                      us(h.lateness_p50_ns), us(h.lateness_p99_ns), us(h.lateness_max_ns),
                      us(h.cycle_cost_p50_ns), static_cast<unsigned long long>(h.overruns), h.gui_fps,
                      h.gui_vertices, s.vertices_asked, s.level_picture, s.level_force, s.points);
        text += line.data();
        text += own_text(s, kPlaced[0]) + "," + own_text(s, kPlaced[1]) + ",";
        std::snprintf(line.data(), line.size(), "%.4f,", s.level_particles);
        text += line.data() + own_text(s, kPlaced[2]);
        for (const std::string& column : more) text += "," + own_text(s, column);
        text += '\n';
    }
    return text;
}

}  // namespace tact::launch
