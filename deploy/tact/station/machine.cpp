#include "deploy/tact/station/machine.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "deploy/tact/child.hpp"
#include "deploy/tact/doctor.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

bool package_installed(const std::string& dpkg_status, const std::string& name) {
    const auto at = dpkg_status.find("Package: " + name + "\n");
    if (at == std::string::npos || (at > 0 && dpkg_status[at - 1] != '\n')) return false;
    const auto end = std::min(dpkg_status.find("\n\n", at), dpkg_status.size());
    return dpkg_status.substr(at, end - at).find("\nStatus: install ok installed") != std::string::npos;
}

std::string whole(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The lines of GRUB_CMDLINE_LINUX and GRUB_CMDLINE_LINUX_DEFAULT.
std::string grub_lines(const std::filesystem::path& file) {
    std::istringstream in(whole(file));
    std::string lines;
    for (std::string line; std::getline(in, line);)
        if (const auto at = line.find_first_not_of(" \t");
            at != std::string::npos && line.compare(at, 18, "GRUB_CMDLINE_LINUX") == 0)
            lines += line.substr(at) + "\n";
    return lines;
}

std::map<std::string, std::vector<std::string>> read_groups(const std::filesystem::path& path) {
    std::map<std::string, std::vector<std::string>> groups;
    std::istringstream in(whole(path));
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string name, skip, members;
        std::getline(fields, name, ':');
        std::getline(fields, skip, ':');
        std::getline(fields, skip, ':');
        std::getline(fields, members, ':');
        auto& all = groups[name];
        std::istringstream list(members);
        for (std::string member; std::getline(list, member, ',');) all.push_back(member);
    }
    return groups;
}

}  // namespace

StationMachine read_station_machine(const std::filesystem::path& root, bool offline) {
    StationMachine m;
    const auto cpu = root / "sys/devices/system/cpu";
    m.cores = parse_core_list(read_small(cpu / "online"));
    if (m.cores.empty())
        throw StartupError("read " + (cpu / "online").string(), "no list of processor cores",
                           "mount the /sys of that machine there");
    for (const int core : m.cores) {
        auto all = parse_core_list(
            read_small(cpu / ("cpu" + std::to_string(core)) / "topology/thread_siblings_list"));
        if (std::find(all.begin(), all.end(), core) == all.end()) all = {core};
        m.siblings[core] = std::move(all);
    }
    std::error_code none;
    m.grub = std::filesystem::exists(root / "etc/default/grub", none);
    m.grub_arguments = grub_lines(root / "etc/default/grub");
    for (const auto& file : std::filesystem::directory_iterator(root / "etc/default/grub.d", none))
        if (file.path().extension() == ".cfg" && file.path().filename() != "tact.cfg")
            m.grub_arguments += grub_lines(file.path());
    m.update_grub = offline || !find_in_path("update-grub").empty();
    m.systemd = offline || std::filesystem::exists("/run/systemd/system", none);
    m.udev = offline || std::filesystem::exists("/run/udev/control", none);
    m.kernel_installed = package_installed(whole(root / "var/lib/dpkg/status"), "linux-image-rt-amd64");
    m.groups = read_groups(root / "etc/group");
    m.own_arguments = read_small(root / "proc/cmdline");
    return m;
}

ServoCores choose_cores(const StationMachine& machine, int core) {
    ServoCores c;
    c.servo = core == -1 ? machine.cores.back() : core;
    const std::string attempt = "keep core " + std::to_string(c.servo) + " for the servo";
    if (std::find(machine.cores.begin(), machine.cores.end(), c.servo) == machine.cores.end())
        throw StartupError(attempt, "the core does not exist",
                           "choose one of " + core_list(machine.cores) + " with --core");
    if (machine.cores.size() < 2)
        throw StartupError(attempt, "it is the only core", "use a machine with two cores or more");
    c.kept = machine.siblings.at(c.servo);
    if (c.kept.size() >= machine.cores.size()) {
        c.shared = true;
        c.kept.assign(1, c.servo);  // g++ 14 wrongly reports an overrun for the assignment of a list
    }
    for (const int other : machine.cores)
        if (std::find(c.kept.begin(), c.kept.end(), other) == c.kept.end()) c.others.push_back(other);
    return c;
}

std::string core_list(const std::vector<int>& cores) {
    std::string text;
    for (std::size_t i = 0; i < cores.size();) {
        std::size_t last = i;
        while (last + 1 < cores.size() && cores[last + 1] == cores[last] + 1) ++last;
        text += (text.empty() ? "" : ",") + std::to_string(cores[i]);
        if (last > i) text += "-" + std::to_string(cores[last]);
        i = last + 1;
    }
    return text;
}

}  // namespace tact::launch
