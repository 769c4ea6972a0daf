// tact station setup and undo on a tree of files: setup writes every promised line, undo restores every byte.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "deploy/tact/station/shipped_files.hpp"
#include "deploy/tact/station/tools.hpp"
#include "deploy/tact/station/transaction.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch::deploy_station_test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& path, const std::string& text, mode_t mode = 0644) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    chmod(path.c_str(), mode);
}

int interrupts_left = -1;
void count_down() {
    if (interrupts_left >= 0 && interrupts_left-- == 0) _exit(77);
}

class Station : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "station-XXXXXX").string();
        root_ = mkdtemp(name.data());
        put(root_ / "sys/devices/system/cpu/online", "0-3\n");
        for (int i = 0; i < 4; ++i)
            put(root_ / ("sys/devices/system/cpu/cpu" + std::to_string(i)) / "topology/thread_siblings_list",
                std::to_string(i % 2) + "," + std::to_string(i % 2 + 2) + "\n");
        put(root_ / "etc/default/grub", "GRUB_DEFAULT=0\nGRUB_CMDLINE_LINUX_DEFAULT=\"quiet\"\n");
        put(root_ / "etc/group", "root:x:0:\nusers:x:100:ann\n");
        put(root_ / "var/lib/dpkg/status", "Package: bash\nStatus: install ok installed\n\n");
        // Files of an older set-up by hand: other contents, other modes, contents that are not text.
        put(root_ / "etc/udev/rules.d/60-tact.rules", std::string("old\0\xff\xfe rules", 13), 0600);
        put(root_ / "etc/security/limits.d/tact.conf", "old limits", 0640);
        put(root_ / "etc/systemd/system/own.service", "[Unit]\n");
        before_ = snapshot();
    }
    void TearDown() override { fs::remove_all(root_); }

    // Every file, link and folder with mode, owner and content.
    [[nodiscard]] std::map<std::string, std::string> snapshot() const {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::recursive_directory_iterator(root_)) {
            struct stat status {};
            lstat(entry.path().c_str(), &status);
            std::string content = std::to_string(status.st_mode) + " " + std::to_string(status.st_uid) + " " +
                                  std::to_string(status.st_gid) + " ";
            if (entry.is_symlink())
                content += fs::read_symlink(entry.path()).string();
            else if (entry.is_regular_file())
                content += text_of(entry.path());
            all[entry.path().lexically_relative(root_).string()] = content;
        }
        return all;
    }
    [[nodiscard]] StationPlan plan(int core = -1) const {
        return make_station_plan(read_station_machine(root_, true),
                                 {.core = core, .user = "ann", .skip = {}, .kernel_packages = {}});
    }
    StationTools tools() {
        return {.root = root_,
                .run =
                    [this](const Command& c) {
                        commands_.push_back(command_text(c));
                        return command_text(c) == fails_ ? 1 : 0;
                    },
                .report = [](const std::string&) {},
                .interrupt = &count_down};
    }
    // Runs setup in a process of its own that ends at the n-th interruption; true: it completed.
    bool setup_killed_at(int n, bool undo = false) {
        const pid_t child = fork();
        if (child == 0) {
            interrupts_left = n;
            undo ? static_cast<void>(undo_station(tools(), false))
                 : static_cast<void>(set_up_station(plan(), tools()));
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 77)) << status;
        return status == 0;
    }
    [[nodiscard]] bool ran(const std::string& command) const {
        return std::find(commands_.begin(), commands_.end(), command) != commands_.end();
    }

    fs::path root_;
    std::map<std::string, std::string> before_;
    std::vector<std::string> commands_;
    std::string fails_;
};

std::string message_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const StartupError& e) {
        return e.what();
    }
    return "";
}

TEST_F(Station, setup_writes_every_line_that_it_promises) {
    EXPECT_EQ(set_up_station(plan(), tools()), SetupResult::done);
    EXPECT_EQ(text_of(root_ / "etc/default/grub.d/tact.cfg"),
              "# Written by tact station setup; tact station undo removes it.\n"
              "GRUB_CMDLINE_LINUX_DEFAULT=\"$GRUB_CMDLINE_LINUX_DEFAULT isolcpus=managed_irq,domain,1,3 "
              "nohz_full=1,3 rcu_nocbs=1,3 irqaffinity=0,2\"\n");
    EXPECT_EQ(text_of(root_ / "etc/systemd/system/tact-rt@.service.d/station.conf"),
              "# Written by tact station setup; tact station undo removes it.\n"
              "[Service]\nCPUAffinity=0,2\nEnvironment=TACT_RT_CORE=--core=3\n");
    EXPECT_NE(
        text_of(root_ / "etc/systemd/system/tact-station.service").find("\nEnvironment=TACT_CORES=1,3\n"),
        std::string::npos);
    EXPECT_EQ(fs::read_symlink(root_ / "etc/systemd/system/multi-user.target.wants/tact-station.service"),
              "/etc/systemd/system/tact-station.service");
    EXPECT_EQ(text_of(root_ / "etc/udev/rules.d/60-tact.rules"), text_of("deploy/60-tact.rules"));
    EXPECT_EQ(text_of(root_ / "etc/security/limits.d/tact.conf"), text_of("deploy/limits.conf"));
    EXPECT_EQ(text_of(root_ / "usr/local/lib/tact/can-up"), text_of("deploy/can-up"));
    EXPECT_EQ(text_of(root_ / "etc/systemd/system/tact-can@.service"), text_of("deploy/tact-can@.service"));
    EXPECT_EQ(text_of(root_ / "usr/local/lib/tact/station-tune"), text_of("deploy/station-tune"));
    struct stat status {};
    ASSERT_EQ(stat((root_ / "usr/local/lib/tact/station-tune").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0755U);
    ASSERT_EQ(stat((root_ / "var/lib/tact/station.json").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0600U);
    for (const char* const command :
         {"env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "
          "linux-image-rt-amd64",
          "groupadd --system tact", "groupadd --system realtime", "usermod -aG tact ann", "update-grub",
          "systemctl daemon-reload", "udevadm control --reload", "systemctl restart tact-station.service"})
        EXPECT_TRUE(ran(command)) << command;
}

TEST_F(Station, undo_restores_every_byte_mode_and_folder) {
    set_up_station(plan(), tools());
    EXPECT_NE(snapshot(), before_);
    commands_.clear();
    EXPECT_TRUE(undo_station(tools(), false));
    EXPECT_EQ(snapshot(), before_);
    for (const char* const command :
         {"update-grub", "groupdel tact", "groupdel realtime", "systemctl stop tact-station.service",
          "env DEBIAN_FRONTEND=noninteractive apt-get purge -y linux-image-rt-amd64"})
        EXPECT_TRUE(ran(command)) << command;
    EXPECT_FALSE(undo_station(tools(), false));
}

TEST_F(Station, undo_restores_everything_after_a_kill_of_setup_at_any_point) {
    int at = 0;
    for (; !setup_killed_at(at); ++at) {
        undo_station(tools(), false);
        ASSERT_EQ(snapshot(), before_) << "killed at " << at;
    }
    EXPECT_GT(at, 30);
}

TEST_F(Station, undo_can_be_repeated_after_a_kill_at_any_point) {
    for (int at = 0;; ++at) {
        ASSERT_TRUE(setup_killed_at(-1));
        const bool ended = setup_killed_at(at, true);
        undo_station(tools(), false);
        ASSERT_EQ(snapshot(), before_) << "killed at " << at;
        if (ended) break;
    }
}

TEST_F(Station, a_second_setup_changes_nothing) {
    set_up_station(plan(), tools());
    const auto once = snapshot();
    commands_.clear();
    EXPECT_EQ(set_up_station(plan(), tools()), SetupResult::already_so);
    EXPECT_EQ(snapshot(), once);
    EXPECT_TRUE(commands_.empty());
}

TEST_F(Station, another_core_or_an_interrupted_setup_must_be_undone_first) {
    set_up_station(plan(), tools());
    EXPECT_NE(message_of([&] { set_up_station(plan(0), tools()); }).find("with core 3"), std::string::npos);
    undo_station(tools(), false);
    ASSERT_FALSE(setup_killed_at(10));
    EXPECT_NE(message_of([&] { set_up_station(plan(), tools()); }).find("interrupted"), std::string::npos);
}

TEST_F(Station, a_file_changed_since_setup_is_kept_without_force) {
    const struct {
        const char* path;
        void (*change)(const fs::path&);
        const char* message;
    } cases[] = {
        {"etc/default/grub.d/tact.cfg",
         [](const fs::path& p) { std::ofstream(p, std::ios::app) << "# mine\n"; }, "was edited"},
        {"etc/udev/rules.d/60-tact.rules", [](const fs::path& p) { chmod(p.c_str(), 0600); }, "another mode"},
        {"etc/security/limits.d/tact.conf", [](const fs::path& p) { fs::remove(p); }, "was removed"},
    };
    for (const auto& c : cases) {
        set_up_station(plan(), tools());
        c.change(root_ / c.path);
        const auto changed = snapshot();
        const std::string message = message_of([&] { undo_station(tools(), false); });
        EXPECT_NE(message.find(c.message), std::string::npos) << message;
        EXPECT_NE(message.find(c.path), std::string::npos) << message;
        EXPECT_EQ(snapshot(), changed);
        EXPECT_NE(message_of([&] { set_up_station(plan(), tools()); }).find(c.message), std::string::npos);
        EXPECT_TRUE(undo_station(tools(), true));
        EXPECT_EQ(snapshot(), before_);
    }
}

TEST_F(Station, a_foreign_file_in_a_new_folder_stays) {
    set_up_station(plan(), tools());
    put(root_ / "etc/default/grub.d/own.cfg", "# mine\n");
    undo_station(tools(), false);
    EXPECT_EQ(text_of(root_ / "etc/default/grub.d/own.cfg"), "# mine\n");
    EXPECT_FALSE(fs::exists(root_ / "etc/default/grub.d/tact.cfg"));
}

TEST_F(Station, a_failed_step_reverts_the_earlier_ones) {
    fails_ = "update-grub";
    const std::string message = message_of([&] { set_up_station(plan(), tools()); });
    EXPECT_NE(message.find("run update-grub: exit code 1"), std::string::npos) << message;
    EXPECT_EQ(snapshot(), before_);
}

TEST_F(Station, a_journal_writable_by_others_is_refused) {
    set_up_station(plan(), tools());
    chmod((root_ / "var/lib/tact/station.json").c_str(), 0666);
    EXPECT_NE(message_of([&] { undo_station(tools(), true); }).find("other than you"), std::string::npos);
    EXPECT_THROW(static_cast<void>(parse_journal("{}")), StartupError);
    Journal journal;
    journal.steps = {{.name = "x",
                      .changes = {{.path = "/etc/../../out", .before = {}, .after = {}, .folders = {}}},
                      .undo_first = {},
                      .undo = {}}};
    EXPECT_THROW(static_cast<void>(parse_journal(journal_text(journal))), StartupError);
}

TEST_F(Station, the_plan_refuses_impossible_requests) {
    StationMachine m = read_station_machine(root_, true);
    EXPECT_NE(message_of([&] {
                  static_cast<void>(
                      make_station_plan(m, {.core = 4, .user = {}, .skip = {}, .kernel_packages = {}}));
              }).find("0-3"),
              std::string::npos);
    EXPECT_THROW(static_cast<void>(make_station_plan(
                     m, {.core = -1, .user = {}, .skip = {"gruop"}, .kernel_packages = {}})),
                 StartupError);
    m.grub_arguments = "GRUB_CMDLINE_LINUX=\"nohz_full=2\"";
    EXPECT_NE(message_of([&] { static_cast<void>(make_station_plan(m, {})); }).find("nohz_full="),
              std::string::npos);
    m.grub_arguments.clear();
    m.grub = false;
    EXPECT_NE(
        message_of([&] { static_cast<void>(make_station_plan(m, {})); }).find("--skip kernel-arguments"),
        std::string::npos);
    EXPECT_NO_THROW(static_cast<void>(
        make_station_plan(m, {.core = -1, .user = {}, .skip = {"kernel-arguments"}, .kernel_packages = {}})));
    m.cores = {0};
    EXPECT_THROW(static_cast<void>(choose_cores(m, -1)), StartupError);
}

TEST(StationCores, all_hardware_threads_of_the_core_are_isolated_if_others_remain) {
    StationMachine m;
    m.cores = {0, 1, 2, 3};
    m.siblings = {{0, {0, 1}}, {1, {0, 1}}, {2, {2, 3}}, {3, {2, 3}}};
    EXPECT_EQ(kernel_arguments_for(choose_cores(m, -1)),
              "isolcpus=managed_irq,domain,2-3 nohz_full=2-3 rcu_nocbs=2-3 irqaffinity=0-1");
    EXPECT_EQ(choose_cores(m, 1).others, (std::vector<int>{2, 3}));
    m.cores = {0, 1};
    const ServoCores two = choose_cores(m, -1);
    EXPECT_EQ(two.kept, std::vector<int>{1});
    EXPECT_TRUE(two.shared);
    EXPECT_EQ(core_list({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
}

TEST(StationTools, packages_to_install_are_read_from_apt_get) {
    EXPECT_EQ(parse_simulated_install("Reading...\nInst linux-image-6.1-rt (6.1 Debian [amd64])\nInst "
                                      "linux-image-rt-amd64 (6.1)\nConf linux-image-6.1-rt (6.1)\n"),
              (std::vector<std::string>{"linux-image-6.1-rt", "linux-image-rt-amd64"}));
    EXPECT_EQ(run_command({"sh", "-c", "exit 3"}), 3);
    EXPECT_EQ(run_command({"there-is-no-such-program"}), 127);
    EXPECT_EQ(output_of({"printf", "a b"}), "a b");
}

}  // namespace
}  // namespace tact::launch::deploy_station_test
