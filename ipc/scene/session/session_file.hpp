// A session (*.tact-session): a scene with what a person made of it, to go on later or elsewhere. The window writes it; `tact run` and the
// window read it.
//
//   {"tact_session": 1,
//    "scene": {"path": "../maps/ring.tact", "checksum": "b2ea02f2bcde7a45"},   path: from the session's folder
//    "bodies": [...],                       as in the file of tact run --poses, which a session therefore is too
//    "contours": ["0.7:ffc259:0.5:solid"],  as of tact-gui --contour
//    "places": [{"name": "before", "bodies": [{"id": 1, "pos_model_a": [x, y, z], "quat_model_body_xyzw": [x, y, z, w]}]}],
//    "window": "traces = false\n...",       as of --window-state
//    "bone": "2026-11-28_085312_session.bone"}                                  from the session's folder
//
// All but tact_session and scene may be absent.
// Input    untrusted: at most kSessionBytesMost, counts and lengths bounded, poses finite. Bodies, contours and window settings are checked by
//          those who use them
// Errors   StartupError
// Thread   any but the servo thread
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr std::size_t kSessionBytesMost = std::size_t{8} << 20;
inline constexpr const char kSessionEnding[] = ".tact-session";

struct Session {
    static constexpr std::size_t kContoursMost = 16, kPlacesMost = 64, kBodiesMost = 1024, kNameMost = 200;
    struct Body {
        std::uint32_t id = 0;
        Pose T_model_body;
    };
    struct Place {
        std::string name;
        std::vector<Body> bodies;
    };
    std::filesystem::path scene;  // absolute
    std::uint64_t scene_checksum = 0;
    std::string bodies;  // a JSON array; empty: none
    std::vector<std::string> contours;
    std::vector<Place> places;
    std::string window;
    std::filesystem::path bone;  // absolute; empty: as baked
};

[[nodiscard]] bool is_session(const std::filesystem::path& file);  // by its ending
// file: names the session in messages, and its folder is where paths begin.
[[nodiscard]] Session read_session_text(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] Session read_session(const std::filesystem::path& file);
// Throws also if `bodies` is not a JSON array.
[[nodiscard]] std::string session_text(const Session& session, const std::filesystem::path& file);

// The scene with its checksum: at its path, or among those that `tact` baked.
[[nodiscard]] std::filesystem::path find_session_scene(const Session& session);

}  // namespace tact
