// Session files with arbitrary bytes: what is accepted is bounded, and writing and reading it gives the same.
#include <cmath>
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/scene/session/session_file.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    const std::filesystem::path file = "/somewhere/a.tact-session";
    Session read;
    try {
        read = read_session_text(text, file);
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
        return false;
    }
    require(read.scene.is_absolute() && (read.bone.empty() || read.bone.is_absolute()));
    require(read.contours.size() <= Session::kContoursMost && read.places.size() <= Session::kPlacesMost);
    for (const Session::Place& place : read.places) {
        require(!place.name.empty() && place.name.size() <= Session::kNameMost && !place.bodies.empty());
        for (const Session::Body& body : place.bodies)
            require(body.T_model_body.finite() && std::abs(body.T_model_body.q.norm() - 1.0) < 1e-9);
    }
    const std::string written = session_text(read, file);
    const Session again = read_session_text(written, file);
    require(again.scene == read.scene && again.scene_checksum == read.scene_checksum &&
            again.bone == read.bone);
    require(again.places.size() == read.places.size() && again.contours.size() == read.contours.size());
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    const std::string scene = R"("scene": {"path": "../a.tact", "checksum": "b2ea02f2bcde7a45"})";
    for (
        const std::string& text :
        {"{\"tact_session\": 1, " + scene + "}",
         "{\"tact_session\": 1, " + scene +
             R"(, "bodies": [{"id": 1}], "contours": ["0.7:ffc259:0.5:solid:hidden"], "bone": "a.bone", "window": "traces = true",
               "places": [{"name": "s", "bodies": [{"id": 1, "pos_model_a": [1, 2, 3], "quat_model_body_xyzw": [0, 0, 0, 1]}]}]})"})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
