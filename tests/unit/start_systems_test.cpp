// The table of systems of the controller.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "ipc/base/error.hpp"
#include "rt/start/systems.hpp"

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
