// tact info SCENE: all data that another program needs to compute the same force from the same files. The folder of
// each system has the formulas of its force (info_docking.cpp, ...).
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run_report.hpp"
#include "deploy/tact/systems.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

json note_lines(const SceneFile& file) {
    json note = json::array();
    const std::string text = read_note(file);
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        if (end > at) note.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return note;
}

json info(const std::filesystem::path& path) {
    const SceneFile file = SceneFile::open(path);
    const SceneMeta m = read_meta(file);
    char checksum[20];
    std::snprintf(checksum, sizeof checksum, "%016llx", static_cast<unsigned long long>(file.checksum()));
    json all = system_of(m.kind).info(file);
    all["path"] = std::filesystem::absolute(path).string();
    all["checksum"] = checksum;
    all["title"] = std::string(m.title);
    all["kind"] = scene_kind_text(m.kind);
    all["note"] = note_lines(file);
    return all;
}

std::string plain(const json& j) {
    if (j.is_string()) return j.get<std::string>();
    if (j.is_number_float()) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", j.get<double>());
        return text;
    }
    if (!j.is_array()) return j.dump(-1, ' ', false, json::error_handler_t::replace);
    std::string text;
    for (const auto& v : j) text += (text.empty() ? "" : ", ") + plain(v);
    return text;
}

bool flat(const json& object) {
    return std::none_of(object.begin(), object.end(), [](const json& v) { return v.is_structured(); });
}

void show(const json& j, const std::string& indent) {
    for (const auto& [key, value] : j.items()) {
        const bool rows = value.is_array() && !value.empty() && !value[0].is_number();
        if (!value.is_object() && !rows) {
            std::printf("%s%-*s  %s\n", indent.c_str(), static_cast<int>(30 - indent.size()), key.c_str(),
                        plain(value).c_str());
            continue;
        }
        std::printf("%s%s\n", indent.c_str(), key.c_str());
        if (value.is_object()) {
            show(value, indent + "  ");
            continue;
        }
        constexpr std::size_t kRowsShown = 64;
        if (value.size() > kRowsShown) {
            std::printf("%s  %zu rows, in full with --json\n", indent.c_str(), value.size());
            continue;
        }
        for (const auto& row : value) {
            std::string line;
            if (!row.is_object()) {
                line = plain(row);
            } else if (flat(row)) {
                for (const auto& [k, v] : row.items())
                    line += (line.empty() ? "" : ", ") + k + " " + plain(v);
            } else {
                show(row, indent + "  ");
                continue;
            }
            std::printf("%s  %s\n", indent.c_str(), line.c_str());
        }
    }
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
    auto* const command =
        app.add_subcommand("info", "List the contents of a baked scene and the formulas of its force");
    const auto scene = std::make_shared<std::filesystem::path>();
    const auto as_json = std::make_shared<bool>(false);
    command->add_option("SCENE", *scene, "Scene file written by tact-prep")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_flag("--json", *as_json, "Print as JSON");
    command->callback([=, &exit_code] {
        const json j = info(*scene);
        if (*as_json)
            std::fputs(report_text(j).c_str(), stdout);
        else
            show(j, "");
        exit_code = 0;
    });
}

}  // namespace tact::launch
