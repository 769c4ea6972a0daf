#include "deploy/tact/scene_switch.hpp"

#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact::launch {

std::string bound_to_one_scene(const RunOptions& o) {
    for (const auto& [name, file] : {std::pair("--record", &o.record),
                                     {"--save", &o.save},
                                     {"--out", &o.out},
                                     {"--json", &o.json},
                                     {"--screenshot", &o.screenshot}})
        if (!file->empty()) return name;
    return {};
}

Asked asked_of(const std::filesystem::path& file) {
    if (!is_session(file)) return {file};
    const Session session = read_session(file);
    return {find_session_scene(session), session.bone, std::filesystem::absolute(file),
            !session.bodies.empty()};
}

std::optional<Asked> SceneSwitch::poll(const SceneFile& shown) {
    try {
        const auto scene = take_asked_scene(folder());
        if (!scene) return std::nullopt;
        if (!bound_by_.empty())
            throw StartupError("opening " + scene->string(),
                               "this run writes files about its own scene at its end (" + bound_by_ + ")",
                               "close the window and start: tact run " + scene->string());
        if (scene->extension() == ".bone") {
            const std::uint64_t belongs_to = drilled_bone_scene(*scene);
            if (belongs_to != shown.checksum())
                throw StartupError("opening " + scene->string(),
                                   belongs_to == 0
                                       ? "it is no file of drilled bone"
                                       : "its bone is of another scene than the one that is shown",
                                   "open the scene that was drilled, then this file");
            return Asked{std::filesystem::absolute(shown.name()), *scene};
        }
        Asked asked = asked_of(*scene);
        static_cast<void>(read_meta(SceneFile::open(asked.scene)));
        return asked;
    } catch (const StartupError& e) {
        refuse(e.what());
        return std::nullopt;
    }
}

void SceneSwitch::refuse(const std::string& why) {
    std::fprintf(stderr, "tact: %s\n", why.c_str());
    try {
        refuse_scene(folder(), why);
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact: could not notify the window: %s\n", e.what());
    }
}

}  // namespace tact::launch
