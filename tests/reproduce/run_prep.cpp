#include "tests/reproduce/run_prep.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

void run_prep(const std::vector<std::string>& arguments, const std::filesystem::path& log,
              const std::string& attempt) {
    ChildSettings s;
    s.arguments = arguments;
    s.output_fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    Child prep("tact-prep", find_program("tact-prep"), s);
    ::close(s.output_fd);
    const auto& ending = prep.wait(std::chrono::seconds(60));
    if (!ending || !ending->clean())
        throw StartupError(attempt,
                           "tact-prep " + (ending ? ending->text() : "did not exit within a minute") + ": " +
                               read_small(log),
                           "run by hand: tact-prep " + arguments.front());
}

}  // namespace tact::launch
