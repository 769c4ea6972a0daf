#include "deploy/tact/child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "deploy/tact/files.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch::deploy_child_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Long, because a machine may pause for seconds; reached only in case of an error.
constexpr seconds kPatience(60);

ChildSettings shell(const std::string& script) {
    ChildSettings s;
    s.arguments = {"-c", script};
    s.grace = kPatience;
    return s;
}

ChildSettings long_sleep() {
    ChildSettings s;
    s.arguments = {"600"};
    s.grace = kPatience;
    return s;
}

template <class F>
bool wait_for(F&& happened) {
    const Instant end = Monotonic::now() + kPatience;
    while (!happened() && Monotonic::now() < end) usleep(2000);
    return happened();
}

// The state letter of /proc/PID/stat: T stopped, t stopped by a tracer, Z dead.
char state_of(pid_t pid) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
    std::string text;
    std::getline(in, text);
    const auto name_end = text.rfind(')');
    return name_end == std::string::npos ? '?' : text.at(name_end + 2);
}

TEST(Child, an_exit_code_is_reported) {
    Child child("sh", "/bin/sh", shell("exit 7"));
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_FALSE(ending->by_signal);
    EXPECT_EQ(ending->number, 7);
    EXPECT_FALSE(ending->clean());
    EXPECT_EQ(ending->text(), "ended with exit code 7");
}

TEST(Child, a_killed_child_is_reported_with_its_signal) {
    Child child("sh", "/bin/sh", shell("kill -9 $$"));
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_TRUE(ending->by_signal);
    EXPECT_EQ(ending->number, SIGKILL);
    EXPECT_FALSE(ending->asked);
    EXPECT_NE(ending->text().find("signal 9"), std::string::npos);
}

TEST(Child, stop_ends_a_running_child) {
    Child child("sleep", "/bin/sleep", long_sleep());
    EXPECT_FALSE(child.poll());
    child.stop();
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_TRUE(ending->asked);
    EXPECT_EQ(ending->number, SIGTERM);
    EXPECT_FALSE(ending->forced);
}

TEST(Child, stop_ends_a_stopped_child) {
    Child child("sleep", "/bin/sleep", long_sleep());
    kill(child.pid(), SIGSTOP);
    ASSERT_TRUE(wait_for([&] { return state_of(child.pid()) == 'T'; }));
    child.stop();
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_EQ(ending->number, SIGTERM);
}

TEST(Child, stop_ends_a_child_that_stops_itself_afterwards) {
    ScratchFolder scratch;
    const auto mark = scratch.path() / "ready";
    // Stops itself on the request to end, and ends once it is continued.
    Child child(
        "sh", "/bin/sh",
        shell("trap 'kill -STOP $$; exit 5' TERM; : > " + mark.string() + "; while :; do sleep 0.01; done"));
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(mark); }));
    child.stop();
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_EQ(ending->number, 5);
    EXPECT_FALSE(ending->forced);
}

// A leak checker stops its own process at exit to inspect it; SIGCONT would undo that stop.
TEST(Child, stop_sends_only_the_request_to_a_running_child) {
    ScratchFolder scratch;
    const auto ready = scratch.path() / "ready", woken = scratch.path() / "woken";
    Child child("sh", "/bin/sh",
                shell("asked=0; trap 'asked=1' TERM; trap ': > " + woken.string() + "' CONT; : > " +
                      ready.string() + "; while [ $asked = 0 ]; do sleep 0.01; done; sleep 0.05; exit 5"));
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(ready); }));
    child.stop();
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_EQ(ending->number, 5);
    EXPECT_FALSE(std::filesystem::exists(woken));
}

TEST(Child, a_child_that_ignores_the_request_is_killed_after_the_grace_time) {
    ScratchFolder scratch;
    const auto mark = scratch.path() / "ready";
    auto settings = shell("trap '' TERM; : > " + mark.string() + "; while :; do sleep 0.05; done");
    settings.grace = milliseconds(100);
    Child child("sh", "/bin/sh", settings);
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(mark); }));
    child.stop();
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_TRUE(ending->forced);
    EXPECT_EQ(ending->number, SIGKILL);
    EXPECT_NE(ending->text().find("did not end on request"), std::string::npos);
}

TEST(Child, a_missing_program_is_refused_with_its_path) {
    try {
        Child child("nothing", "/nonexistent/program", {});
        FAIL() << "no error";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("/nonexistent/program"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("fix:"), std::string::npos);
    }
}

TEST(Child, gets_the_given_environment_without_empty_variables) {
    ScratchFolder scratch;
    const auto out = scratch.path() / "out";
    setenv("TACT_TEST_GONE", "1", 1);
    auto settings = shell("echo \"$TACT_TEST_NEW/${TACT_TEST_GONE-none}\" > " + out.string());
    settings.environment = {{"TACT_TEST_NEW", "here"}, {"TACT_TEST_GONE", ""}};
    Child child("sh", "/bin/sh", settings);
    ASSERT_TRUE(child.wait(kPatience));
    EXPECT_EQ(read_small(out), "here/none\n");
}

TEST(Child, does_not_inherit_the_signals_that_tact_blocks) {
    const Signals blocked;
    Child child("sleep", "/bin/sleep", long_sleep());
    kill(child.pid(), SIGINT);
    const auto& ending = child.wait(kPatience);
    ASSERT_TRUE(ending);
    EXPECT_EQ(ending->number, SIGINT);
}

TEST(Child, ends_with_its_object) {
    pid_t pid = 0;
    {
        Child child("sleep", "/bin/sleep", long_sleep());
        pid = child.pid();
    }
    EXPECT_EQ(kill(pid, 0), -1);
}

TEST(Signals, a_request_to_end_is_returned_and_a_dead_child_only_wakes) {
    Signals signals;
    Child child("true", "/bin/true", {});
    ASSERT_TRUE(child.wait(kPatience));
    EXPECT_EQ(signals.wait(0), 0);
    kill(getpid(), SIGTERM);
    EXPECT_EQ(signals.wait(1000), SIGTERM);
    EXPECT_EQ(signals.wait(0), 0);
}

TEST(Files, a_file_is_written_completely_without_leftovers) {
    ScratchFolder scratch;
    const auto path = scratch.path() / "a" / "b.json";
    write_whole(path, "one");
    write_whole(path, "two");
    EXPECT_EQ(read_small(path), "two");
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& e : std::filesystem::directory_iterator(path.parent_path())) ++files;
    EXPECT_EQ(files, 1U);
}

TEST(Files, an_unwritable_folder_is_reported_with_its_path) {
    ScratchFolder scratch;
    std::ofstream(scratch.path() / "file") << "x";
    try {
        write_whole(scratch.path() / "file" / "under", "content");
        FAIL() << "no error";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("under"), std::string::npos);
    }
}

TEST(ContentHash, differs_for_different_splits_of_the_same_text) {
    ContentHash a, b, c;
    a.add("ab");
    a.add("c");
    b.add("a");
    b.add("bc");
    c.add("ab");
    c.add("c");
    EXPECT_NE(a.hex(), b.hex());
    EXPECT_EQ(a.hex(), c.hex());
}

}  // namespace
}  // namespace tact::launch::deploy_child_test
