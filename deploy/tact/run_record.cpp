#include "deploy/tact/run_record.hpp"

#include <array>
#include <cstdio>

#include "ipc/topics/text.hpp"

namespace tact::launch {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

}  // namespace

std::optional<Sample> take_sample(const RtRegion& region, const Places* places, double t_s) {
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
        if (const auto particles = level_at(*levels, kParticlesPathIndex))
            s.level_particles = particles->level;
    }
    if (const auto drill = newest(region.drill))
        s.taken_m3 = static_cast<double>(drill->removed_levels) * drill->level_m3;
    if (const auto bodies = newest(region.bodies); bodies && places != nullptr) {
        const auto all = places->bodies(*bodies);
        if (all && bodies->active < all->size()) s.offset = places->offset((*all)[bodies->active]);
    }
    return s;
}

std::string table_header(const Sample& s) {
    const std::string first =
        "                      force ----- lateness us -----\n"
        "  t s  state             Hz     p50     p99     max  overruns";
    if (s.taken_m3) return first + "      rays   fps  level picture, force, particles  bone taken\n";
    return first + "  vertices   fps  level mesh, force   from the file's place\n";
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
    line[0] = 0;
    if (s.taken_m3)
        std::snprintf(line.data(), line.size(), ",       %4.2f  %7.1f mm3", s.level_particles,
                      1e9 * *s.taken_m3);
    else if (s.offset)
        std::snprintf(line.data(), line.size(), "   %7.2f A %6.2f deg", s.offset->distance_a,
                      s.offset->angle_deg);
    return text + line.data() + "\n";
}

std::string samples_csv(const std::vector<Sample>& samples) {
    std::string text =
        "t_s,state,force_rate_hz,goal_hz,lateness_p50_us,lateness_p99_us,lateness_max_us,cycle_cost_p50_us,"
        "overruns,"
        "gui_fps,gui_vertices,vertices_asked,level_picture,level_force,points,offset_a,angle_deg,"
        "level_particles,bone_taken_mm3\n";
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
        if (s.offset) {
            std::snprintf(line.data(), line.size(), "%.4f,%.4f,", s.offset->distance_a, s.offset->angle_deg);
            text += line.data();
        } else {
            text += ",,";
        }
        std::snprintf(line.data(), line.size(), "%.4f,", s.level_particles);
        text += line.data();
        if (s.taken_m3) {
            std::snprintf(line.data(), line.size(), "%.3f", 1e9 * *s.taken_m3);
            text += line.data();
        }
        text += '\n';
    }
    return text;
}

}  // namespace tact::launch
