// Determines which right to real-time priority, locked memory or devices a user lacks, and why.
//
// A right needs four steps, and the first missing one is to be fixed: membership of the group, a session that began
// after it, the limits file, and a session to which the limits were applied. read_person() gathers the data; the rest
// is pure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct Person {
    bool root = false;
    std::vector<std::string> groups{};  // groups of this process
    std::vector<std::string> listed{};  // groups of the user in the database
    std::string limits{};               // text of /etc/security/limits.d/tact.conf; "": missing
};

[[nodiscard]] Person read_person(const std::filesystem::path& root = "/");

enum class Lacking : std::uint8_t { nothing, membership, login, limits_file, session, capability };

// membership, login or nothing.
[[nodiscard]] Lacking lacking_group(const Person& person, const std::string& group);
// Why a limit is not in force; limits do not apply to root, who lacks a capability instead. item: its name in
// limits.conf, "rtprio" or "memlock".
[[nodiscard]] Lacking lacking_limit(const Person& person, const std::string& item);

// "this user is not a member of the group realtime"; "" for Lacking::nothing.
[[nodiscard]] std::string lacking_text(Lacking lacking, const std::string& group);
[[nodiscard]] std::string lacking_fix(Lacking lacking);

}  // namespace tact::launch
