// The table of systems of the controller.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "ipc/base/error.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "rt/start/systems.hpp"
#include "tests/unit/force_tool_scene.hpp"

namespace tact::start_systems_test {
namespace {

TEST(Systems, each_kind_has_one_row_with_a_model_and_a_visual_path) {
    std::set<std::string> names;
    std::set<SceneKind> kinds;
    for (const System& s : systems()) {
        EXPECT_TRUE(names.insert(s.name).second) << s.name;
        EXPECT_TRUE(kinds.insert(s.kind).second) << s.name;
        EXPECT_NE(s.make, nullptr) << s.name;
        EXPECT_FALSE(s.visual_paths.empty()) << s.name;
        for (const VisualPath& path : s.visual_paths) EXPECT_FALSE(path.knob.haptic) << s.name;
        EXPECT_EQ(&system_of(s.kind), &s);
    }
}

// The costs of a tool differ from the constants: they are of this machine and this surface.
TEST(Systems, a_mesh_tool_knows_its_costs_before_the_loop_starts) {
    const RoughSphereScene scene(false);
    const StartOptions options;
    const RtConfig config;
    const auto region = std::make_unique<RtRegion>();
    const auto model =
        system_of(SceneKind::surface).make({*scene.file, options, config, *region}, nullptr, 0);
    EXPECT_NE(model->predict(1.0F).cost_predicted,
              load_tool_model(*scene.file, options.surface)->predict(1.0F).cost_predicted);
}

TEST(Systems, a_kind_without_a_row_is_refused) {
    EXPECT_THROW((void)system_of(static_cast<SceneKind>(999)), StartupError);
}

TEST(Systems, only_driven_tools_have_a_switch) {
    EXPECT_EQ(system_of(SceneKind::docking).drive, nullptr);
    ASSERT_NE(system_of(SceneKind::drilling).drive, nullptr);
    RtConfig config;
    config.drilling.pedal = "always";
    EXPECT_EQ(system_of(SceneKind::drilling).drive(config, 0).by, DriveSwitch::always);
}

}  // namespace
}  // namespace tact::start_systems_test
