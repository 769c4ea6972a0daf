// Files of drilled bone in the state folder: one for each run that drilled, the newest of which stay.
//
// Errors  StartupError
#pragma once

#include <cstdint>
#include <filesystem>

namespace tact::launch {

inline constexpr std::size_t kBoneFilesKept = 20;

// A new name in state_folder()/drilled, after the scene and the time. Removes the oldest files beyond kBoneFilesKept, but
// not `resumed`.
[[nodiscard]] std::filesystem::path new_bone_file(const std::filesystem::path& scene,
                                                  const std::filesystem::path& resumed);
// The newest file of this scene. Fails if there is none.
[[nodiscard]] std::filesystem::path last_bone_file(std::uint64_t scene_checksum);

}  // namespace tact::launch
