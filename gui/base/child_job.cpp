#include "gui/base/child_job.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ipc/base/error.hpp"

extern "C" char** environ;

namespace tact {
namespace {

std::string beside_this(const std::string& program) {
    if (program.find('/') != std::string::npos) return program;
    std::error_code ignored;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    const auto beside = folder / program;
    return access(beside.c_str(), X_OK) == 0 ? beside.string() : program;
}

std::string tail_of(int fd) {
    std::string text(ChildJob::kOutputMax, '\0');
    const off_t size = lseek(fd, 0, SEEK_END);
    const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
    const ssize_t got = pread(fd, text.data(), text.size(), from);
    text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return text;
}

}  // namespace

ChildJob::~ChildJob() {
    if (pid_ > 0) {
        kill(pid_, SIGKILL);  // it writes its files completely or not at all
        while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    if (output_fd_ >= 0) close(output_fd_);
}

void ChildJob::start(const std::string& program, const std::vector<std::string>& arguments) {
    const std::string path = beside_this(program);
    if (running()) throw StartupError("starting " + program, "it is already running", "wait until it ends");
    if (output_fd_ >= 0) close(output_fd_);
    output_fd_ = memfd_create("tact-child-output", MFD_CLOEXEC);
    if (output_fd_ < 0) throw StartupError("starting " + program, std::strerror(errno), "free some memory");
    std::vector<char*> words{const_cast<char*>(path.c_str())};
    for (const std::string& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, output_fd_, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, output_fd_, STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t ours;  // the child must not inherit this process's signal handling
    sigemptyset(&ours);
    for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ours, s);
    posix_spawnattr_setsigdefault(&attributes, &ours);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, path.c_str(), &files, &attributes, words.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        throw StartupError("starting " + path, std::strerror(error),
                           "build it, or put it beside this program (it is part of Tact)");
    pid_ = pid;
}

std::string ChildJob::output() const { return output_fd_ >= 0 ? tail_of(output_fd_) : std::string(); }

void ChildJob::cancel() const {
    if (pid_ > 0) kill(pid_, SIGTERM);
}

std::optional<ChildOutcome> ChildJob::poll() {
    if (pid_ <= 0) return std::nullopt;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
    pid_ = 0;
    ChildOutcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.output = tail_of(output_fd_);
    return outcome;
}

}  // namespace tact
