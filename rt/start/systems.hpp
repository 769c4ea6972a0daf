// The systems that the controller supports: one row per kind of scene. A new system needs a folder in rt/force and a row.
//
// Thread  start-up; fails by StartupError
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/force_model.hpp"
#include "rt/servo/servo_settings.hpp"
#include "rt/start/start_options.hpp"

namespace tact {

// Data shared by the models of a run, with an optional region that a window may map. Outlives the models.
class SharedScene {
public:
    virtual ~SharedScene() = default;
    [[nodiscard]] virtual int fd() const { return -1; }  // of the region; -1: none
};

// The inputs of a system; outlives it.
struct SystemInput {
    const SceneFile& scene;
    const StartOptions& options;
    const RtConfig& config;
    RtRegion& region;
};

struct System {
    SceneKind kind;
    const char* name;
    std::span<const VisualPath> visual_paths;
    // Makes the model of a hand and sets the topic that it publishes.
    std::unique_ptr<ForceModel> (*make)(const SystemInput& input, SharedScene* shared, std::uint32_t hand);
    std::unique_ptr<SharedScene> (*share)(const SystemInput& input) = nullptr;  // null: no shared data
    DriveInput (*drive)(const RtConfig& config, std::uint32_t hand) = nullptr;  // null: no driven tools
    std::string (*summary)(const RtRegion& region) = nullptr;  // for the log at the end; null: none
};

[[nodiscard]] std::span<const System> systems();
[[nodiscard]] const System& system_of(SceneKind kind);

// The system of one run.
class SceneSystem {
public:
    explicit SceneSystem(const SystemInput& input);

    [[nodiscard]] int fd() const { return shared_ ? shared_->fd() : -1; }  // of the shared region; -1: none
    [[nodiscard]] std::span<const VisualPath> visual_paths() const { return system_.visual_paths; }
    // Returns a PointerModel if the system has no model for the hand.
    [[nodiscard]] std::unique_ptr<ForceModel> make_model(std::uint32_t hand) const;
    [[nodiscard]] DriveInput drive(std::uint32_t hand) const;
    [[nodiscard]] std::string summary() const;  // empty: none

private:
    SystemInput input_;
    const System& system_;
    std::unique_ptr<SharedScene> shared_;
};

}  // namespace tact
