#include "deploy/tact/scene_switch.hpp"

#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact::launch {

namespace {

bool has_more(const SceneFile& scene, const SceneFile& shown) {
    const auto whole = read_bake_record(read_note(scene)), part = read_bake_record(read_note(shown));
    return whole && part && extends(*whole, *part);
}

}  // namespace

std::string bound_to_one_scene(const RunOptions& o, bool extends) {
    if (extends) return o.record.empty() ? "" : "--record";
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
        const auto check_bound = [&](const std::string& bound_by) {
            if (!bound_by.empty())
                throw StartupError("opening " + scene->string(),
                                   "this run writes files about its own scene at its end (" + bound_by + ")",
                                   "close the window and start: tact run " + scene->string());
        };
        if (!is_session(*scene)) check_bound(bound_by_);
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
        const SceneFile file = SceneFile::open(asked.scene);
        static_cast<void>(read_meta(file));
        const bool more = asked.bodies && has_more(file, shown),
                   fewer = asked.bodies && !more && has_more(shown, file);
        asked.extends = more || fewer;
        check_bound(asked.extends ? bound_extending_by_ : bound_by_);
        // What the window wrote of the scene that is shown; when a structure is taken back, as it was when it was added.
        const auto back = folder() / (fewer ? kAddedSession : kShownSession);
        if (asked.extends && std::filesystem::exists(back)) asked.back = back;
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
