#include "tests/scenario/rig.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact::scenario {

namespace {

constexpr double kA = 1e-10;

// A bent rod of atoms in a map of Gaussians around them: small, so that a controller starts quickly.
void bake_rod(const std::filesystem::path& path) {
    constexpr std::size_t kAtoms = 120;
    constexpr std::uint32_t kSize = 24;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-2.0 * kA, 2.0 * kA);
    Structure rod;
    rod.name = "rod";
    rod.mass_u = 12.0 * kAtoms;
    rod.home_com_model_m = Vec3::Constant(kA * kSize);
    std::vector<Vec3> place;
    Vec3 com = Vec3::Zero();
    for (std::size_t i = 0; i < kAtoms; ++i) {
        const double s = 2.0 * static_cast<double>(i) / kAtoms - 1.0;
        place.emplace_back(12.0 * kA * s + jitter(random), 7.0 * kA * s * s + jitter(random), jitter(random));
        com += place.back() / kAtoms;
    }
    for (const Vec3& p : place) {
        rod.x_m.push_back(static_cast<float>((p - com).x()));
        rod.y_m.push_back(static_cast<float>((p - com).y()));
        rod.z_m.push_back(static_cast<float>((p - com).z()));
    }
    rod.mass_fraction.assign(kAtoms, 1.0F / kAtoms);
    rod.element.assign(kAtoms, 6);
    rod.chain.assign(kAtoms, 0);
    rod.residue.assign(kAtoms, 1);
    rod.trace.assign(kAtoms, 1);
    rod.chain_names = {"A"};
    DensityGrid grid;
    grid.size = {kSize, kSize, kSize};
    grid.spacing_m = Vec3::Constant(2.0 * kA);
    grid.values.assign(grid.count(), 0.0F);
    for (std::uint32_t z = 0; z < kSize; ++z)
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) {
                double v = 0.0;
                for (std::size_t i = 0; i < kAtoms; i += 4) {
                    const Vec3 away = 2.0 * kA * Vec3(x, y, z) - (rod.home_com_model_m + place[i] - com);
                    v += std::exp(-away.squaredNorm() / (2.0 * 16.0 * kA * kA));
                }
                grid.values[(std::size_t{z} * kSize + y) * kSize + x] = static_cast<float>(v);
            }
    SceneMeta meta{};
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 0.1 / (2.0 * kA * kSize);
    for (double& c : meta.centre_model_m) c = kA * kSize;
    meta.energy_j_per_sigma = 0.02;
    meta.map_sigma = 1.5;
    meta.resolution_m = 8.0 * kA;
    SceneWriter out;
    write_meta(out, meta, "scenario: a bent rod");
    write_grid(out, grid);
    write_structure(out, 0, rod);
    write_codebook(out, 0, {});
    out.write(path);
}

std::string content_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}

int new_file(const std::filesystem::path& path) {
    return open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0600);
}

std::filesystem::path log_name(const Rig& rig) {
    static int number = 0;
    return rig.folder() / ("log-" + std::to_string(number++));
}

launch::ChildSettings settings_of(const Rig& rig, const std::vector<std::string>& more,
                                  const std::string& more_config, int log_fd) {
    launch::ChildSettings s;
    const auto config =
        rig.file("tact.toml", "[device]\nhand = \"wander\"\nwatchdog_us = 1e6\n" + more_config);
    s.arguments = {rig.scene().string(), "--session", rig.session(), "--config", config.string()};
    if (std::find(more.begin(), more.end(), "--priority") == more.end())
        s.arguments.insert(s.arguments.end(), {"--priority", "0"});
    s.arguments.insert(s.arguments.end(), more.begin(), more.end());
    s.output_fd = log_fd;
    s.grace = std::chrono::minutes(1);  // a busy machine must not look like a hang
    return s;
}

launch::Child start(const std::filesystem::path& log, const Rig& rig, const std::vector<std::string>& more,
                    const std::string& more_config) {
    const FileDescriptor fd(new_file(log));
    return {"tact-rt", rt_program(), settings_of(rig, more, more_config, fd.get())};
}

}  // namespace

bool until(const std::function<bool()>& condition) {
    const Instant end = Monotonic::now() + std::chrono::minutes(1);
    while (Monotonic::now() < end) {
        if (condition()) return true;
        ::poll(nullptr, 0, 1);
    }
    return condition();
}

std::filesystem::path rt_program() { return TACT_RT_PROGRAM; }

Rig::Rig() {
    setenv("TACT_RUNTIME_DIR", folder().c_str(), 1);
    bake_rod(scene());
}

std::filesystem::path Rig::file(const std::string& name, const std::string& content) const {
    launch::write_whole(folder() / name, content);
    return folder() / name;
}

bool Rig::lock_is_free() const {
    const FileDescriptor lock(open((folder() / "tact-scenario.lock").c_str(), O_RDWR | O_CLOEXEC));
    return !lock.valid() || flock(lock.get(), LOCK_EX | LOCK_NB) == 0;
}

std::optional<Said> run_to_end(const Rig& rig, const std::filesystem::path& program,
                               std::vector<std::string> arguments, const std::string& runtime_folder) {
    const auto log = log_name(rig);
    const FileDescriptor fd(new_file(log));
    launch::ChildSettings s;
    s.arguments = std::move(arguments);
    s.output_fd = fd.get();
    if (!runtime_folder.empty()) s.environment = {{"TACT_RUNTIME_DIR", runtime_folder}};
    launch::Child child(program.filename().string(), program, s);
    const auto ending = child.wait(std::chrono::minutes(1));
    if (!ending) return std::nullopt;
    return Said{*ending, content_of(log)};
}

Controller::Controller(const Rig& rig, const std::vector<std::string>& more, const std::string& more_config)
    : log_(log_name(rig)), child_(start(log_, rig, more, more_config)) {}

std::string Controller::said() const { return content_of(log_); }

bool Watch::attach(std::uint64_t not_generation) {
    return until([&] {
        observer_.poll();
        return observer_.seen() && observer_.attached() && observer_.generation() != not_generation &&
               launch::newest(observer_.region().health).has_value();
    });
}

HealthTopic Watch::health() {
    observer_.poll();
    return observer_.seen() ? launch::newest(observer_.region().health).value_or(HealthTopic{})
                            : HealthTopic{};
}

ToolTopic Watch::tool() {
    observer_.poll();
    return observer_.seen() ? launch::newest(observer_.region().tool[0]).value_or(ToolTopic{}) : ToolTopic{};
}

double Watch::force_n() {
    const ToolTopic t = tool();
    return std::hypot(t.force_world_n[0], t.force_world_n[1], t.force_world_n[2]);
}

bool Watch::cycles_pass(std::uint64_t count) {
    const std::uint64_t from = tool().cycle;
    return until([&] { return tool().cycle >= from + count; });
}

int Visual::ready_region() {
    region_.mark_ready();
    return region_.fd();
}

bool Visual::frame() {
    link_.poll();
    LoadTopic load{};
    load.taken_at_ns = to_ns(Monotonic::now());
    load.frame = ++frames_;
    load.frame_s = 0.016;
    load.busy_s = 0.002;
    load.fps = 60.0;
    load.vertices_drawn = 1000;
    load.vertices_max = 2000;
    region_->load.publish(load);
    return link_.attached();
}

std::uint64_t Visual::send(CommandKind kind, double value, const std::string& text) {
    CommandTopic c{};
    c.sequence = ++commands_;
    c.taken_at_ns = to_ns(Monotonic::now());
    c.value = value;
    c.kind = static_cast<std::uint16_t>(kind);
    std::strncpy(c.text, text.c_str(), sizeof c.text - 1);
    region_->commands.push(c);
    return c.sequence;
}

CommandResult command(Visual& visual, Watch& watch, CommandKind kind, double value, const std::string& text) {
    // The controller ignores commands from before the attachment, so wait for it.
    if (!until([&] { return visual.frame() && watch.health().gui_attached != 0; }))
        return CommandResult::none;
    const std::uint64_t number = visual.send(kind, value, text);
    HealthTopic h{};
    const bool answered = until([&] {
        visual.frame();
        h = watch.health();
        return h.command_sequence == number || h.state_sequence == number;
    });
    if (!answered) return CommandResult::none;
    return static_cast<CommandResult>(h.state_sequence == number ? h.state_result : h.command_result);
}

bool bring_to_force(Visual& visual, Watch& watch) {
    return until([&] {
        visual.frame();
        // Arms again if a paused machine made the controller treat the process as silent.
        if (watch.state() == RunState::ready &&
            command(visual, watch, CommandKind::arm) == CommandResult::none)
            return false;
        return watch.state() == RunState::active && watch.force_n() > 0.01;
    });
}

}  // namespace tact::scenario
