#include "deploy/tact/doctor.hpp"

#include <errno.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "ipc/base/fifo.hpp"
#include "ipc/base/rights.hpp"

namespace tact::launch::deploy_doctor_test {
namespace {

// A PC set up for a haptic device: Debian 12, linux-image-rt-amd64, core 3 isolated.
Machine tuned() {
    Machine m;
    m.kernel_version = "6.1.0-18-rt-amd64 #1 SMP PREEMPT_RT Debian 6.1.76-1 (2024-02-01)";
    m.realtime = "1\n";
    m.isolated = "3\n";
    m.nohz_full = "3\n";
    m.governors = {"performance\n", "performance\n", "performance\n", "performance\n"};
    m.rt_runtime_us = "950000\n";
    m.swaps = "Filename\t\t\t\tType\t\tSize\t\tUsed\t\tPriority\n";
    m.huge_pages = "always [madvise] never\n";
    m.clocksource = "tsc\n";
    m.cpuinfo = "processor\t: 0\nvendor_id\t: GenuineIntel\nflags\t\t: fpu vme de tsc msr\n\n";
    m.capabilities = "Name:\ttact\nCapEff:\t0000000000000000\nCapBnd:\t000001ffffffffff\n";
    m.rtprio_max = 95;
    m.memlock_bytes_max = ~0ULL;
    m.cores = 4;
    return m;
}

Finding one(const Machine& m, const std::string& name) {
    const auto all = judge(m);
    const auto at = std::find_if(all.begin(), all.end(), [&](const Finding& f) { return f.name == name; });
    return at == all.end() ? Finding{} : *at;
}

TEST(Doctor, a_tuned_machine_needs_no_fix) {
    for (const Finding& f : judge(tuned())) {
        EXPECT_EQ(f.level, FindingLevel::ok) << f.name << ": " << f.says;
        EXPECT_EQ(f.fix, "") << f.name;
    }
}

TEST(Doctor, every_warning_has_a_fix) {
    Machine m = tuned();
    m.kernel_version = "6.1.0-18-amd64 #1 SMP PREEMPT_DYNAMIC Debian 6.1.76-1 (2024-02-01)";
    m.realtime = m.isolated = m.nohz_full = "";
    m.governors = {"powersave\n", "powersave\n"};
    m.swaps += "/dev/nvme0n1p3                          partition\t999420\t\t0\t\t-2\n";
    m.huge_pages = "[always] madvise never\n";
    m.clocksource = "hpet\n";
    m.cpuinfo = "processor\t: 0\nflags\t\t: fpu vme hypervisor lahf_lm\n";
    m.rtprio_max = 0;
    m.memlock_bytes_max = 8ULL << 20U;
    m.cores = 2;
    m.fifo_error = EPERM;
    m.dma_latency_error = EACCES;
    m.servos = {{100, 1, "default"}, {200, 1, "lab2"}};
    int warnings = 0;
    for (const Finding& f : judge(m)) {
        if (f.level == FindingLevel::ok) continue;
        ++warnings;
        EXPECT_NE(f.fix, "") << f.name;
    }
    EXPECT_EQ(warnings, 12);  // all except the throttling, which is only reported
}

TEST(Doctor, a_refused_priority_names_the_limit_that_refuses_it) {
    Machine m = tuned();
    m.fifo_error = EPERM;
    m.rtprio_max = 0;
    EXPECT_NE(one(m, "rtprio").says.find("RLIMIT_RTPRIO is 0"), std::string::npos);
    EXPECT_NE(one(m, "rtprio").says.find("not a member of the group realtime"), std::string::npos);
    EXPECT_EQ(one(m, "rtprio").fix, kRightsFix);
    m.rtprio_max = 99;
    EXPECT_NE(one(m, "rtprio").says.find("container"), std::string::npos);
}

TEST(Doctor, controllers_on_one_core_are_warned_about) {
    Machine m = tuned();
    EXPECT_EQ(one(m, "servo_cores").says, "no controller runs pinned to a core");
    m.servos = {{100, 3, "default"}, {200, 2, "lab2"}};
    EXPECT_EQ(one(m, "servo_cores").level, FindingLevel::ok);
    EXPECT_EQ(one(m, "servo_cores").says,
              "running controllers: session default on core 3, session lab2 on core 2");
    m.servos.push_back({300, 3, "lab3"});
    EXPECT_EQ(one(m, "servo_cores").level, FindingLevel::warn);
    EXPECT_NE(
        one(m, "servo_cores").says.find("core 3 is shared by session default (process 100), session lab3"),
        std::string::npos);
    EXPECT_EQ(one(m, "servo_cores").fix, kSharedCoreFix);
}

TEST(Doctor, the_missing_step_is_reported_with_its_own_fix) {
    Machine m = tuned();
    m.fifo_error = EPERM;
    m.rtprio_max = 0;
    m.memlock_bytes_max = 8ULL << 20U;
    m.dma_latency_error = EACCES;
    const auto expect = [&](const char* text, const char* fix) {
        for (const char* const name : {"rtprio", "memlock"}) {
            EXPECT_NE(one(m, name).says.find(text), std::string::npos) << one(m, name).says;
            EXPECT_EQ(one(m, name).fix, fix) << name;
        }
    };
    m.person.groups = {"users"};
    m.person.listed = {"users"};
    expect("not a member of the group realtime", kRightsFix);
    EXPECT_EQ(one(m, "dma_latency").fix, kRightsFix);
    m.person.listed = {"users", "realtime"};
    expect("this session began before that", kLoginFix);
    EXPECT_EQ(one(m, "dma_latency").fix, kLoginFix);
    m.person.groups = {"users", "realtime"};
    expect("tact.conf is missing", kRightsFix);
    m.person.limits = "# @realtime - rtprio 95\n@audio - rtprio 95\n@audio - memlock unlimited\n";
    expect("tact.conf is missing or does not grant this limit", kRightsFix);
    std::ifstream shipped("deploy/limits.conf");
    m.person.limits = {std::istreambuf_iterator<char>(shipped), {}};
    expect("this session does not have it", kSessionLimitsFix);
    m.person.limits = "@realtime - rtprio 95\n";  // one of the two
    EXPECT_EQ(one(m, "rtprio").fix, kSessionLimitsFix);
    EXPECT_EQ(one(m, "memlock").fix, kRightsFix);
    m.person = {true, {}, {}, ""};  // root without the capability, in a container
    expect("root lacks the capability", kCapabilityFix);
}

TEST(Doctor, a_person_is_read_with_the_groups_of_the_process_and_of_the_database) {
    const Person p = read_person("/nowhere");
    EXPECT_EQ(p.root, geteuid() == 0);
    EXPECT_FALSE(p.listed.empty());  // at least the process's own group
    EXPECT_EQ(p.limits, "");
}

TEST(Doctor, the_fixes_for_rights_are_defined_once) {
    std::string all;
    for (const char* const path :
         {"deploy/tact/doctor.cpp", "deploy/tact/probe.cpp", "deploy/tact/probe_request.cpp",
          "deploy/tact/rights.cpp", "rt/threads/thread_setup.cpp", "ipc/base/fifo.hpp"}) {
        std::ifstream in(path);
        ASSERT_TRUE(in) << path;
        all += std::string(std::istreambuf_iterator<char>(in), {});
    }
    for (const char* const part : {"install.sh", "usermod", "log in again", "pam_limits"})
        EXPECT_EQ(all.find(part), std::string::npos) << part << " belongs into ipc/base/rights.hpp";
}

TEST(Doctor, a_limit_below_the_supervisors_priority_is_named) {
    Machine m = tuned();
    m.fifo_error = EPERM;
    m.rtprio_max = 94;
    EXPECT_NE(one(m, "rtprio").says.find("SCHED_FIFO 95 is refused: RLIMIT_RTPRIO is 94"), std::string::npos)
        << one(m, "rtprio").says;
}

TEST(Doctor, the_file_of_limits_grants_the_highest_priority_there_is) {
    std::ifstream in("deploy/limits.conf");
    int granted = 0;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string who, kind, what;
        int value = 0;
        if (words >> who >> kind >> what >> value && who == "@realtime" && what == "rtprio") granted = value;
    }
    EXPECT_EQ(granted, kSupervisorPriority);
}

TEST(Doctor, an_isolated_core_with_a_tick_is_a_warning) {
    Machine m = tuned();
    m.nohz_full = "";
    EXPECT_EQ(one(m, "isolation").level, FindingLevel::warn);
    EXPECT_NE(one(m, "isolation").fix.find("nohz_full=3"), std::string::npos);
}

TEST(Doctor, root_may_lock_memory_whatever_the_limit) {
    Machine m = tuned();
    m.memlock_bytes_max = 65536;
    EXPECT_EQ(one(m, "memlock").level, FindingLevel::warn);
    m.capabilities = "CapInh:\t0000000000000000\nCapEff:\t000001ffffffffff\n";
    EXPECT_EQ(one(m, "memlock").level, FindingLevel::ok);
}

TEST(Doctor, a_wayland_session_without_an_x_server_is_told_to_install_xwayland) {
    const Finding without = judge_display("", "wayland-0", true);
    EXPECT_EQ(without.level, FindingLevel::warn);
    EXPECT_NE(without.says.find("wayland-0"), std::string::npos) << without.says;
    EXPECT_NE(without.fix.find("xwayland"), std::string::npos) << without.fix;
    EXPECT_EQ(judge_display(":0", "wayland-0", true).level, FindingLevel::ok);
    EXPECT_EQ(judge_display(":0", "", true).fix, "");
    EXPECT_EQ(judge_display("", "", true).level, FindingLevel::ok);
    EXPECT_EQ(judge_display("", "", false).level, FindingLevel::fail);
}

TEST(Doctor, core_lists_are_read_as_the_kernel_writes_them) {
    EXPECT_EQ(parse_core_list("2-4,7\n"), (std::vector<int>{2, 3, 4, 7}));
    EXPECT_EQ(parse_core_list("0\n"), (std::vector<int>{0}));
    for (const char* const bad : {"", "\n", "(null)\n", "3-", "-3", "4-2", "1,x", "1-99999999999"})
        EXPECT_TRUE(parse_core_list(bad).empty()) << bad;
}

TEST(Doctor, small_texts_of_proc_are_read) {
    EXPECT_EQ(chosen_word("always [madvise] never\n"), "madvise");
    EXPECT_EQ(chosen_word("]["), "");
    EXPECT_EQ(chosen_word(""), "");
    EXPECT_TRUE(has_capability("CapEff:\t0000000000800000\n", 23));
    EXPECT_FALSE(has_capability("CapEff:\t0000000000800000\n", 14));
    EXPECT_FALSE(has_capability("", 0));
    EXPECT_TRUE(parse_swaps("Filename Type Size Used Priority\n").empty());
    EXPECT_EQ(parse_swaps("Filename Type\n/swapfile file 1 0 -2\n/dev/sda2 partition 1 0 -3\n"),
              (std::vector<std::string>{"/swapfile", "/dev/sda2"}));
}

TEST(Doctor, reading_a_machine_without_the_files_gives_no_crash) {
    const Machine m = read_machine("/nonexistent");
    EXPECT_GE(m.cores, 1);
    EXPECT_TRUE(m.governors.empty());
    EXPECT_EQ(m.dma_latency_error, ENOENT);
    EXPECT_FALSE(judge(m).empty());
}

}  // namespace
}  // namespace tact::launch::deploy_doctor_test
