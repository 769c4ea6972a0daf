#include "tests/reproduce/fitting_hand.hpp"

#include <algorithm>
#include <cstddef>

#include "hal/sim/sim_hand.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/command.hpp"
#include "prep/docking/bake_docking.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact::launch {
namespace {

constexpr double kForceMax_n = 3.0, kTorqueMax_n_m = 0.1;
constexpr Duration kStep = std::chrono::milliseconds(1);

Vec3 cut(const Vec3& v, double most) { return v.norm() > most ? Vec3(v * (most / v.norm())) : v; }

}  // namespace

struct HandInMap::Scene {
    std::vector<std::byte> bytes;
};

HandInMap::HandInMap(const DensityGrid& grid, const Structure& structure, double resolution_m)
    : scene_(std::make_unique<Scene>()) {
    DockingInput input;
    input.title = "fitting";
    input.grid = grid;
    input.structures = {structure};
    input.resolution_m = resolution_m;
    input.vertices_max = 1000;
    SceneWriter out;
    bake_docking(input, out);
    scene_->bytes = out.to_bytes();
}

HandInMap::~HandInMap() = default;

Pose HandInMap::led_from(const Pose& start, const std::vector<SearchHit>& places, bool laplacian,
                         double seconds) const {
    DockingSettings settings;
    settings.bodies = {{.structure = 0, .T_model_body = start, .fixed = false, .in_hand = true}};
    std::unique_ptr<ForceModel> model =
        load_docking_model(SceneFile::from_bytes(scene_->bytes, "fitting"), settings);
    const auto turn_on = [&](CommandKind command) {
        ModelOrder order;
        order.kind = ModelOrder::Kind::setting;
        order.command = static_cast<std::uint8_t>(command);
        order.on = true;
        static_cast<void>(model->order(order));
    };
    if (laplacian) {
        turn_on(CommandKind::set_laplacian);
        std::unique_ptr<ForceModel> next = model->rebuild(model->bodies());
        static_cast<void>(next->adopt(*model));
        model = std::move(next);
    }
    if (!places.empty()) {
        ModelOrder order;
        order.kind = ModelOrder::Kind::setting;
        order.command = static_cast<std::uint8_t>(CommandKind::add_found_place);
        order.body = model->bodies().id[0];
        for (const SearchHit& hit : places) {
            order.T_model_body = hit.T_model_body;
            order.value = std::clamp(hit.score / places.front().score, 0.0, 1.0);
            static_cast<void>(model->order(order));
        }
        turn_on(CommandKind::set_pull);
    }
    SimHand hand({}, Vec3::Constant(1.0));
    ToolState tool;
    tool.T_world_tool = hand.pose();
    model->reset(tool);
    const auto steps = static_cast<int>(seconds / to_s(kStep));
    for (int i = 0; i < steps; ++i) {
        tool.T_world_tool = hand.pose();
        tool.twist_world = hand.twist();
        const Wrench felt = model->step(tool, Budget{}).wrench_world;
        hand.step(kStep, {cut(felt.force_n, kForceMax_n), cut(felt.torque_n_m, kTorqueMax_n_m)});
    }
    return model->bodies().T_model_body[0];
}

}  // namespace tact::launch
