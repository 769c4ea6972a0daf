#include "deploy/tact/system_run.hpp"

#include "ipc/base/error.hpp"

namespace tact::launch {

void SystemRun::check_save(const std::filesystem::path& folder) const {
    throw StartupError("saving to " + folder.string(), "a scene of this kind has nothing to save",
                       "run the scene without --save, or dock files: tact dock MAP MODEL --save DIR");
}

}  // namespace tact::launch
