// Controllers pinned to a core, from made-up /proc trees and from the real one.
#include "ipc/shm/servo_threads.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace tact::ipc_servo_threads_test {
namespace {

namespace fs = std::filesystem;

class Proc {
public:
    Proc() : root_(fs::temp_directory_path() / ("tact_proc_" + std::to_string(getpid()))) {
        fs::create_directories(root_);
    }
    ~Proc() { fs::remove_all(root_); }
    void file(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path, std::ios::binary) << text;
    }
    void thread(int process, int thread, const std::string& name, const std::string& cores) const {
        const std::string folder = std::to_string(process) + "/task/" + std::to_string(thread) + "/";
        file(folder + "comm", name + "\n");
        file(folder + "status", "Name:\t" + name + "\nCpus_allowed:\t8\nCpus_allowed_list:\t" + cores +
                                    "\nMems_allowed_list:\t0\n");
    }
    // As shown by the kernel: main thread, servo, and helpers excluded from its core.
    void controller(int process, const std::string& core, const std::string& words = "") const {
        const std::string folder = std::to_string(process) + "/";
        file(folder + "comm", "tact-rt\n");
        std::string line = std::string("/opt/tact-rt") + '\0' + "scene.tact" + '\0';
        for (const char c : words) line += c == ' ' ? '\0' : c;
        file(folder + "cmdline", words.empty() ? line : line + '\0');
        thread(process, process, "tact-rt", "0-3");
        thread(process, process + 1, "servo", core);
        thread(process, process + 2, "builder", "0-2");
    }
    [[nodiscard]] const fs::path& root() const { return root_; }

private:
    fs::path root_;
};

std::string text_of(const std::vector<PinnedServo>& servos) {
    std::string all;
    for (const PinnedServo& s : servos)
        all += std::to_string(s.process) + ":" + std::to_string(s.core) + ":" + s.session + " ";
    return all;
}

TEST(ServoThreads, each_pinned_servo_is_found_with_its_core_and_session) {
    const Proc proc;
    EXPECT_EQ(text_of(pinned_servos(proc.root())), "");
    proc.controller(300, "3", "--session lab2 --core 3");
    proc.controller(100, "3");
    proc.controller(200, "2", "--session=left");
    proc.controller(400, "0-3", "--session free");  // not pinned
    proc.file("500/comm", "python3\n");             // the same thread name in another program
    proc.thread(500, 501, "servo", "3");
    proc.file("self/comm", "tact-rt\n");
    EXPECT_EQ(text_of(pinned_servos(proc.root())), "100:3:default 200:2:left 300:3:lab2 ");
}

TEST(ServoThreads, a_controller_gets_the_names_of_others_on_its_core_only) {
    const Proc proc;
    proc.controller(100, "3");
    proc.controller(200, "2", "--session left");
    EXPECT_EQ(shared_core_text(pinned_servos(proc.root()), 100), "");
    EXPECT_EQ(shared_cores_text(pinned_servos(proc.root())), "");
    proc.controller(300, "3", "--session lab2");
    const auto servos = pinned_servos(proc.root());
    EXPECT_EQ(shared_core_text(servos, 300),
              "core 3 is also the core of session default (process 100): the force loops delay each other");
    EXPECT_EQ(shared_core_text(servos, 100),
              "core 3 is also the core of session lab2 (process 300): the force loops delay each other");
    EXPECT_EQ(shared_core_text(servos, 200), "");
    EXPECT_EQ(shared_core_text(servos, 999), "");  // is itself not pinned
    EXPECT_EQ(shared_cores_text(servos),
              "core 3 is shared by session default (process 100), session lab2 (process 300)");
}

TEST(ServoThreads, hostile_text_is_bounded_and_not_echoed) {
    const Proc proc;
    proc.controller(100, "3", "--session \x1b[2Jevil");
    proc.controller(200, "3", "--session " + std::string(5000, 'x'));
    proc.controller(300, "3", "--session");
    proc.controller(400, "99999999999999");
    proc.controller(500, "");
    proc.controller(600, "3x");
    proc.file("700/comm", "tact-rt\n");  // ended in between
    proc.file("800/task", "no folder");
    proc.file("800/comm", "tact-rt\n");
    EXPECT_EQ(text_of(pinned_servos(proc.root())), "100:3:? 200:3:? 300:3:default ");
    EXPECT_EQ(text_of(pinned_servos(proc.root() / "nowhere")), "");
}

TEST(ServoThreads, the_real_proc_can_be_read) {
    for (const PinnedServo& s : pinned_servos()) {
        EXPECT_GT(s.process, 0);
        EXPECT_GE(s.core, 0);
    }
    EXPECT_EQ(shared_core_text(pinned_servos(), getpid()), "");  // the test is not a controller
}

}  // namespace
}  // namespace tact::ipc_servo_threads_test
