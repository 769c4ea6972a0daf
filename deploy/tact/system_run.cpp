#include "deploy/tact/system_run.hpp"

#include "ipc/base/error.hpp"

namespace tact::launch {

void SystemRun::check_save(const std::filesystem::path& folder) const {
    throw StartupError("saving into " + folder.string(), "a scene of this kind has nothing to save",
                       "run it without --save, or dock files: tact dock MAP MODEL --save DIR");
}

}  // namespace tact::launch
