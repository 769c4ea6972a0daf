// What the set-up of a station has to know of the machine, read below a root.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tact::launch {

struct StationMachine {
    std::vector<int> cores;                    // online
    std::map<int, std::vector<int>> siblings;  // threads of the same physical core, itself included
    bool grub = false;                         // /etc/default/grub is there
    bool update_grub = false;
    bool systemd = false, udev = false;  // run now
    bool kernel_installed = false;       // linux-image-rt-amd64
    std::string grub_arguments;          // of /etc/default/grub and its folder, but for Tact's own file
    std::map<std::string, std::vector<std::string>> groups;  // name: members
    std::string own_arguments;                               // /proc/cmdline
};

// offline: a tree of files; what runs now is then of no concern and taken to run. Throws StartupError: no processors.
[[nodiscard]] StationMachine read_station_machine(const std::filesystem::path& root, bool offline);

struct ServoCores {
    int servo = -1;
    std::vector<int> kept;    // isolated: the servo's, and those of the same physical core
    std::vector<int> others;  // all else runs there
    bool shared = false;      // a sibling had to stay with the others, because nothing else would be left
};

// core -1: the last. Throws StartupError: there is no such core, or no other one.
[[nodiscard]] ServoCores choose_cores(const StationMachine& machine, int core);

[[nodiscard]] std::string core_list(const std::vector<int>& cores);  // "0-2,5"

}  // namespace tact::launch
