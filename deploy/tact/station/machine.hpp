// State of the machine that the set-up of a station depends on, read below a root.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tact::launch {

struct StationMachine {
    std::vector<int> cores;                    // online
    std::map<int, std::vector<int>> siblings;  // hardware threads of the same physical core, itself included
    bool grub = false;                         // /etc/default/grub exists
    bool update_grub = false;
    bool systemd = false, udev = false;  // running now
    bool kernel_installed = false;       // linux-image-rt-amd64
    std::string grub_arguments;          // of /etc/default/grub and its folder, without Tact's own file
    std::map<std::string, std::vector<std::string>> groups;  // name: members
    std::string own_arguments;                               // /proc/cmdline
};

// offline: a tree of files; services are then assumed to run. Throws StartupError if no processor is found.
[[nodiscard]] StationMachine read_station_machine(const std::filesystem::path& root, bool offline);

struct ServoCores {
    int servo = -1;
    std::vector<int> kept;    // isolated: the servo's core and its hardware threads
    std::vector<int> others;  // cores for all other work
    bool shared = false;      // siblings of the servo's core stay in `others`, as no other core is left
};

// core -1: the last. Throws StartupError if the core does not exist or is the only one.
[[nodiscard]] ServoCores choose_cores(const StationMachine& machine, int core);

[[nodiscard]] std::string core_list(const std::vector<int>& cores);  // "0-2,5"

}  // namespace tact::launch
