// What a user lacks of the rights to real-time priority, locked memory and devices, and why.
//
// The rights come in four steps, and the first that is missing is the one to fix: membership of the group, a session that
// began after it, the file of limits, and a session that the limits were applied to. read_person() gathers, the
// rest is pure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct Person {
    bool root = false;
    std::vector<std::string> groups{};  // of this process
    std::vector<std::string> listed{};  // of the user, in the database of groups
    std::string limits{};               // text of /etc/security/limits.d/tact.conf; "": there is none
};

[[nodiscard]] Person read_person(const std::filesystem::path& root = "/");

enum class Lacking : std::uint8_t { nothing, membership, login, limits_file, session, capability };

// membership, login or nothing.
[[nodiscard]] Lacking lacking_group(const Person& person, const std::string& group);
// Why a limit is not in force; root has no use for limits and lacks a capability. item: as limits.conf names it, "rtprio" or "memlock".
[[nodiscard]] Lacking lacking_limit(const Person& person, const std::string& item);

// "this user is not a member of the group realtime"; "" for nothing.
[[nodiscard]] std::string lacking_text(Lacking lacking, const std::string& group);
[[nodiscard]] std::string lacking_fix(Lacking lacking);

}  // namespace tact::launch
