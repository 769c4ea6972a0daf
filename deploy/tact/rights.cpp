#include "deploy/tact/rights.hpp"

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "deploy/tact/files.hpp"
#include "ipc/base/rights.hpp"

namespace tact::launch {
namespace {

constexpr const char* kRealtime = "realtime";
constexpr std::size_t kGroupsMax = 256, kBuffer = 16384;

std::vector<std::string> names_of(const gid_t* ids, int count) {
    std::vector<std::string> names;
    std::vector<char> buffer(kBuffer);
    for (int i = 0; i < count; ++i) {
        group g{}, *found = nullptr;
        if (getgrgid_r(ids[i], &g, buffer.data(), buffer.size(), &found) == 0 && found != nullptr)
            names.emplace_back(found->gr_name);
    }
    return names;
}

// The present groups of this process' user in the group database.
std::vector<std::string> listed_groups() {
    std::vector<char> buffer(kBuffer);
    passwd p{}, *found = nullptr;
    if (getpwuid_r(getuid(), &p, buffer.data(), buffer.size(), &found) != 0 || found == nullptr) return {};
    std::array<gid_t, kGroupsMax> ids{};
    int count = static_cast<int>(ids.size());
    if (getgrouplist(p.pw_name, p.pw_gid, ids.data(), &count) < 0) count = static_cast<int>(ids.size());
    return names_of(ids.data(), count);
}

bool has(const std::vector<std::string>& groups, const std::string& name) {
    return std::find(groups.begin(), groups.end(), name) != groups.end();
}

// True if the text has a line such as "@realtime - rtprio 95".
bool grants(const std::string& limits, const std::string& item) {
    std::istringstream lines(limits);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string who, kind, what, value;
        if (words >> who >> kind >> what >> value && who == std::string("@") + kRealtime && what == item)
            return true;
    }
    return false;
}

}  // namespace

Person read_person(const std::filesystem::path& root) {
    Person p;
    p.root = geteuid() == 0;
    std::array<gid_t, kGroupsMax> ids{};
    p.groups = names_of(ids.data(), std::max(getgroups(static_cast<int>(ids.size()), ids.data()), 0));
    p.listed = listed_groups();
    p.limits = read_small(root / "etc/security/limits.d/tact.conf");
    return p;
}

Lacking lacking_group(const Person& person, const std::string& group) {
    if (has(person.groups, group)) return Lacking::nothing;
    return has(person.listed, group) ? Lacking::login : Lacking::membership;
}

Lacking lacking_limit(const Person& person, const std::string& item) {
    if (person.root) return Lacking::capability;
    if (const Lacking of_group = lacking_group(person, kRealtime); of_group != Lacking::nothing)
        return of_group;
    return grants(person.limits, item) ? Lacking::session : Lacking::limits_file;
}

std::string lacking_text(Lacking lacking, const std::string& group) {
    switch (lacking) {
        case Lacking::nothing:
            return "";
        case Lacking::membership:
            return "this user is not a member of the group " + group;
        case Lacking::login:
            return "this user is a member of the group " + group + ", but this session began before that";
        case Lacking::limits_file:
            return "/etc/security/limits.d/tact.conf is missing or does not grant this limit";
        case Lacking::session:
            return "/etc/security/limits.d/tact.conf grants this limit, but this session does not have it";
        case Lacking::capability:
            return "root lacks the capability for it, as in a container";
    }
    return "";
}

std::string lacking_fix(Lacking lacking) {
    switch (lacking) {
        case Lacking::nothing:
            return "";
        case Lacking::membership:
        case Lacking::limits_file:
            return kRightsFix;
        case Lacking::login:
            return kLoginFix;
        case Lacking::session:
            return kSessionLimitsFix;
        case Lacking::capability:
            return kCapabilityFix;
    }
    return "";
}

}  // namespace tact::launch
