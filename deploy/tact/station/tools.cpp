#include "deploy/tact/station/tools.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <functional>
#include <sstream>

#include "deploy/tact/station/plan.hpp"

namespace tact::launch {
namespace {

// output: write end of a pipe for the command's output; -1: standard error.
int spawn_and_wait(const Command& command, int output, const std::function<void()>& meanwhile) {
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output >= 0 ? output : STDERR_FILENO, STDOUT_FILENO);
    pid_t child = -1;
    const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) return 127;
    meanwhile();
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int run_command(const Command& command) {
    return spawn_and_wait(command, -1, [] {});
}

std::string output_of(const Command& command) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {};
    std::string text;
    const int code = spawn_and_wait(command, ends[1], [&] {
        close(ends[1]);
        ends[1] = -1;
        std::array<char, 4096> some{};
        for (ssize_t n = 0; (n = read(ends[0], some.data(), some.size())) > 0;)
            text.append(some.data(), static_cast<std::size_t>(n));
    });
    if (ends[1] >= 0) close(ends[1]);
    close(ends[0]);
    return code == 0 ? text : "";
}

std::vector<std::string> parse_simulated_install(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string first, name;
        if (fields >> first >> name && first == "Inst") names.push_back(name);
    }
    return names;
}

std::vector<std::string> kernel_packages_to_come() {
    return parse_simulated_install(output_of(
        {"env", "LC_ALL=C", "apt-get", "-s", "install", "--no-install-recommends", kKernelPackage}));
}

}  // namespace tact::launch
