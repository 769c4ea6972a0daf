// A session of a scene, continued in a scene that was baked from the same files and more structures.
//
// Bodies   those of the session keep poses and flags (none: the structures at the positions in their files); each new structure gets one
//          body, the first of them in the hand: at the position in its file if it overlaps the map there, else beside the map
// Errors   StartupError
// Thread   any but the servo thread; reads the whole scene
#pragma once

#include "ipc/scene/session/session_file.hpp"

namespace tact {

class SceneFile;

// A controller numbers the bodies that it starts with from 1, in the order of the list: the snapshots follow. Bodies that are no longer
// there are left out.
void number_bodies(Session& session);

// before: a session of the scene `shown`, of which `extended` begins with all structures.
[[nodiscard]] Session extended_session(const Session& before, const SceneFile& shown,
                                       const SceneFile& extended);

}  // namespace tact
