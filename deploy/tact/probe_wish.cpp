#include <grp.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "deploy/tact/probe.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

DeviceWish read_device_wish(const std::string& path) {
    toml::table file;
    try {
        file = toml::parse_file(path);
    } catch (const toml::parse_error& e) {
        const auto line = e.source().begin.line;
        throw StartupError(
            "reading the configuration " + path + (line == 0 ? "" : ":" + std::to_string(line)),
            std::string(e.description()),
            line == 0 ? "give the path of a readable file to --config, or leave it out"
                      : "mend this line; deploy/tact.toml shows the form");
    }
    DeviceWish wish;
    struct Key {
        const char *section, *name;
        std::string* target;
    };
    for (const Key& key : std::array{
             Key{"device", "driver", &wish.driver}, Key{"device", "serial", &wish.serial},
             Key{"device", "firmware", &wish.firmware}, Key{"device", "hd_library", &wish.hd_library},
             Key{"tracker", "driver", &wish.tracker}, Key{"tracker", "interface", &wish.tracker_interface},
             Key{"tracker", "format", &wish.tracker_format}, Key{"lines", "driver", &wish.lines},
             Key{"lines", "chip", &wish.lines_chip}}) {
        const auto node = file[key.section][key.name];
        if (!node) continue;
        if (!node.is_string())
            throw StartupError(path + ": " + key.section + "." + key.name, "this is not a text in quotes",
                               "see deploy/tact.toml for the key and its default");
        *key.target = node.value_or(std::string());
    }
    std::error_code error;
    if (const auto bytes = std::filesystem::file_size(wish.firmware, error);
        !error && access(wish.firmware.c_str(), R_OK) == 0)
        wish.firmware_bytes = static_cast<std::int64_t>(bytes);
    return wish;
}

Person read_person() {
    Person p;
    p.root = geteuid() == 0;
    std::array<gid_t, 256> ids{};
    const int n = getgroups(static_cast<int>(ids.size()), ids.data());
    for (int i = 0; i < n; ++i) {
        group g{}, *found = nullptr;
        char buffer[4096];
        if (getgrgid_r(ids[static_cast<std::size_t>(i)], &g, buffer, sizeof buffer, &found) == 0 &&
            found != nullptr)
            p.groups.emplace_back(found->gr_name);
    }
    return p;
}

std::string find_hd_library(const std::filesystem::path& root, const std::string& configured) {
    std::error_code error;
    if (!configured.empty()) return std::filesystem::exists(configured, error) ? configured : "";
    for (std::string place : probe::kHdPlaces) {
        if (!place.starts_with("/")) continue;  // the loader's own search: not repeated here
        if (std::filesystem::exists(root / place.substr(1), error)) return place;
    }
    return "";
}

}  // namespace tact::launch
