// Parts of the configuration reader: the table of keys, and sections that need more than one row per key.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "hal/arm/arm_table.hpp"
#include "rt/config/config.hpp"

namespace tact {

// One row per key: its target and its valid values. The only list of keys.
struct ConfigKey {
    std::string name;
    std::variant<double*, std::int64_t*, bool*, std::string*, std::span<double>> target;
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    std::vector<std::string> words;  // the valid texts; empty: any
};
[[nodiscard]] std::vector<ConfigKey> keys_of(RtConfig& config);
// Describes the problem with the key's current value; empty if it is valid.
[[nodiscard]] std::string complaint(const ConfigKey& key);
// The known key with the longest common prefix and suffix.
[[nodiscard]] std::string nearest(const std::vector<ConfigKey>& keys, const std::string& name);
// Sets the key and checks only the type. where: location for the error that it throws.
void set_key(const ConfigKey& key, const toml::node& node, const std::string& where);

// Runs one reading step and collects the error that it throws.
template <class F>
void collect(ConfigErrors& errors, F step) {
    try {
        step();
    } catch (const ConfigError& e) {
        errors.push_back(e);
    }
}

// Reads the section [arm]. path: of the file, for messages.
void read_arm_section(const toml::table& section, const std::string& path, ArmParameterSet& arm,
                      ConfigErrors& errors);

// Formats a number for messages.
std::string number_text(double v);

}  // namespace tact
