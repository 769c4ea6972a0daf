#include "deploy/tact/x_server.hpp"

#include <gtest/gtest.h>

#include "deploy/tact/files.hpp"

namespace tact::launch::deploy_x_server_test {
namespace {

TEST(XServer, several_start_at_once_with_different_numbers) {
    if (find_in_path("Xvfb").empty()) GTEST_SKIP() << "there is no Xvfb";
    const ScratchFolder a, b, c;
    XServer one(a.path(), 640, 480), two(b.path(), 640, 480), three(c.path(), 640, 480);
    EXPECT_NE(one.display(), two.display());
    EXPECT_NE(two.display(), three.display());
    for (XServer* const x : {&one, &two, &three}) {
        EXPECT_FALSE(x->child().poll());
        EXPECT_TRUE(std::filesystem::exists("/tmp/.X11-unix/X" + x->display().substr(1)));
        x->child().stop();
        const auto& ending = x->child().wait(std::chrono::seconds(60));
        ASSERT_TRUE(ending);
        EXPECT_FALSE(ending->forced);
    }
}

TEST(XServer, its_cookie_is_readable_only_by_this_user) {
    if (find_in_path("Xvfb").empty()) GTEST_SKIP() << "there is no Xvfb";
    const ScratchFolder scratch;
    const XServer x(scratch.path(), 640, 480);
    const auto file = scratch.path() / "xauthority";
    EXPECT_EQ(std::filesystem::status(file).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_EQ(std::filesystem::file_size(file), 2U + 2U + 2U + 2U + 18U + 2U + 16U);
}

}  // namespace
}  // namespace tact::launch::deploy_x_server_test
