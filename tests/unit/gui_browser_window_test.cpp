// A person opens the list of scenes with a key and clicks another scene, which the launcher then runs.
// All programs are the real ones, on a separate X server.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "deploy/tact/child.hpp"
#include "deploy/tact/x_server.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/support/map_file.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_browser_window_test {
namespace {

using std::chrono::milliseconds;
constexpr std::chrono::seconds kPatience(120);  // reached only on failure

class BrowserInTheWindow : public testing::Test {
protected:
    void SetUp() override {
        for (const char* const program : {"Xvfb", "xdotool"})
            if (launch::find_in_path(program).empty())
                GTEST_SKIP() << program << " is not installed: keys and clicks cannot be sent";
        char name[] = "/tmp/tact-browser-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
        setenv("XDG_STATE_HOME", (folder_ + "/state").c_str(), 1);
        setenv("XDG_CACHE_HOME", (folder_ + "/cache").c_str(), 1);
        std::filesystem::create_directory(folder_ + "/cache");
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // graphics drivers keep memory until exit on purpose
        x_server_ = std::make_unique<launch::XServer>(folder_, 1280, 720);
        for (const auto& [key, value] : x_server_->environment())
            value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
        first_ = folder_ + "/first.tact";
        second_ = folder_ + "/second.tact";
        fake::write_helix_scene(first_);
        fake::write_helix_scene(second_);
        std::ofstream(folder_ + "/broken.tact") << "cut short";
        std::filesystem::create_directories(folder_ + "/state/tact");
        std::ofstream(folder_ + "/state/tact/recent.json")
            << R"({"scenes": [{"path": ")" << second_ << R"(", "used_unix_s": 2}, {"path": ")" << folder_
            << R"(/broken.tact", "used_unix_s": 1}, {"path": "/gone/away.tact", "used_unix_s": 1}]})";
        tact_ = fork();
        if (tact_ == 0) {
            if (freopen((folder_ + "/said").c_str(), "w", stdout) == nullptr || dup2(1, 2) < 0) _exit(126);
            execl(TACT_PROGRAM, TACT_PROGRAM, "run", first_.c_str(), "--session", "t", "--size", "1280x720",
                  "--texts", (folder_ + "/texts.json").c_str(), nullptr);
            _exit(127);
        }
        ASSERT_TRUE(wait_for_words("showing " + first_)) << log();
        ASSERT_EQ(std::system("xdotool search --sync --name '^Tact' windowfocus --sync >/dev/null 2>&1"), 0);
    }
    void TearDown() override {
        if (tact_ > 0) {
            kill(tact_, SIGTERM);
            waitpid(tact_, nullptr, 0);
        }
        x_server_.reset();
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }
    [[nodiscard]] std::string log() const {
        std::ifstream file(folder_ + "/said");
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] std::string recents() const {
        std::ifstream file(folder_ + "/state/tact/recent.json");
        return {std::istreambuf_iterator<char>(file), {}};
    }
    bool wait_for_words(const std::string& words) {
        const Instant until = Monotonic::now() + kPatience;
        while (Monotonic::now() < until) {
            if (log().find(words) != std::string::npos) return true;
            std::this_thread::sleep_for(milliseconds(100));
        }
        return false;
    }
    static void x(const std::string& words) {
        ASSERT_EQ(std::system(("xdotool " + words + " >/dev/null 2>&1").c_str()), 0) << words;
    }

    // The middle of a text on the window, as xdotool wants it; empty: it is not shown.
    [[nodiscard]] std::string place_of(const std::string& label) const {
        std::ifstream file(folder_ + "/texts.json");
        const std::string all{std::istreambuf_iterator<char>(file), {}};
        const auto texts = nlohmann::json::parse(all, nullptr, false);
        if (texts.is_discarded()) return {};
        for (const auto& t : texts["texts"]) {
            const std::string text = t["text"];
            if (text.substr(0, label.size()) != label) continue;
            const auto middle = [&t](const char* at, const char* size) {
                return std::to_string(std::lround(t[at].get<double>() + 0.5 * t[size].get<double>()));
            };
            return middle("x", "w") + " " + middle("y", "h");
        }
        return {};
    }
    // Clicks a text until another is shown: a busy window may miss a click.
    void click(const std::string& label, const std::string& then) {
        const Instant until = Monotonic::now() + kPatience;
        while (Monotonic::now() < until) {
            if (const std::string place = place_of(label); !place.empty()) {
                x("mousemove " + place);
                std::this_thread::sleep_for(milliseconds(200));
                x("mousedown 1");
                std::this_thread::sleep_for(milliseconds(200));
                x("mouseup 1");
            }
            const Instant seen_by = Monotonic::now() + std::chrono::seconds(5);
            while (Monotonic::now() < seen_by) {
                std::this_thread::sleep_for(milliseconds(100));
                if (log().find(then) != std::string::npos || !place_of(then).empty()) return;
            }
        }
        ADD_FAILURE() << label << " was clicked, but '" << then << "' was not shown\n" << log();
    }
    // Opens the list and shows the folder of the scenes.
    void open_folder() {
        const Instant until = Monotonic::now() + kPatience;
        while (place_of("Recently used").empty() && Monotonic::now() < until) {
            x("key --clearmodifiers o");
            std::this_thread::sleep_for(milliseconds(500));
        }
        click("Folder", "../");
    }

    std::string folder_, first_, second_;
    std::unique_ptr<launch::XServer> x_server_;
    pid_t tact_ = 0;
};

TEST_F(BrowserInTheWindow, a_clicked_scene_runs_and_becomes_the_newest_of_the_list) {
    open_folder();
    click("second.tact", "requesting from the launcher: " + second_);
    ASSERT_TRUE(wait_for_words("showing " + second_)) << log();
    EXPECT_NE(log().find("another scene was requested: " + second_), std::string::npos) << log();
    const Instant until = Monotonic::now() + kPatience;
    while (recents().find("second.tact") > recents().find("first.tact") && Monotonic::now() < until)
        std::this_thread::sleep_for(milliseconds(20));
    EXPECT_LT(recents().find("second.tact"), recents().find("first.tact")) << recents();
    EXPECT_NE(recents().find("/gone/away.tact"), std::string::npos) << "missing files stay in the list";
    kill(tact_, SIGINT);
    int status = 0;
    waitpid(std::exchange(tact_, 0), &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << log();
}

TEST_F(BrowserInTheWindow, marked_raw_data_in_the_folder_is_imported_and_run) {
    const std::string mesh = folder_ + "/tetra.obj";
    std::ofstream(mesh) << "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    open_folder();
    click("tetra.obj", "Clear");
    click("Import", "importing " + mesh);
    EXPECT_TRUE(wait_for_words("showing " + folder_ + "/cache/tact/tetra-")) << log();
}

// xdotool presses a key for less than a frame; Backspace and Enter must reach the field all the same.
TEST_F(BrowserInTheWindow, the_resolution_of_a_map_is_typed_corrected_and_entered) {
    const Structure helix = fake::helix(18);
    std::ofstream(folder_ + "/a.mrc", std::ios::binary)
        << map_file_bytes(fake::density_of(helix, 24, 40.0 / 23.0, 3.0));
    std::ofstream pdb(folder_ + "/a.pdb");
    for (std::size_t i = 0; i < helix.size(); ++i) {
        const Vec3 at_a = (helix.home_com_model_m + Vec3(static_cast<double>(helix.x_m[i]),
                                                         static_cast<double>(helix.y_m[i]),
                                                         static_cast<double>(helix.z_m[i]))) /
                          kAngstromM;
        pdb << printed("ATOM  %5zu  CA  ALA A%4zu    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1, i + 1,
                       at_a.x(), at_a.y(), at_a.z());
    }
    pdb.close();
    open_folder();
    click("a.mrc", "1 marked");
    click("a.pdb", "Dock a.pdb into a.mrc.");
    // Keys that come before the field has the keyboard are lost, as in any program.
    click("Import", "asking about " + folder_ + "/a.mrc");
    x("type --delay 100 19");
    x("key BackSpace");
    std::this_thread::sleep_for(milliseconds(300));
    x("type --delay 100 1.5");
    x("key Return");
    EXPECT_TRUE(wait_for_words("importing " + folder_ + "/a.mrc")) << log();
    const std::string baked = folder_ + "/cache/tact/a-";
    ASSERT_TRUE(wait_for_words("showing " + baked)) << log();
    for (const auto& file : std::filesystem::directory_iterator(folder_ + "/cache/tact")) {
        if (file.path().extension() != ".tact") continue;
        EXPECT_NEAR(read_meta(SceneFile::open(file.path())).resolution_m, 11.5 * kAngstromM, 1e-15);
    }
}

}  // namespace
}  // namespace tact::gui_browser_window_test
