// The parts that the configuration is read with: the list of keys, and sections that are more than a row per key.
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

// One row a key: where it goes and what it may be. The only list of keys there is.
struct ConfigKey {
    std::string name;
    std::variant<double*, std::int64_t*, bool*, std::string*, std::span<double>> target;
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    std::vector<std::string> words;  // of a text that is one of a few
};
[[nodiscard]] std::vector<ConfigKey> keys_of(RtConfig& config);
// Empty: fine. Else what is wrong with the value that the key has now.
[[nodiscard]] std::string complaint(const ConfigKey& key);
// The known key that shares most of its beginning and end with a wrong one.
[[nodiscard]] std::string nearest(const std::vector<ConfigKey>& keys, const std::string& name);
// Sets the key, also to a value that is then refused. where: of the error that it throws.
void set_key(const ConfigKey& key, const toml::node& node, const std::string& where);

// Runs one step of reading and keeps the error that it throws.
template <class F>
void collect(ConfigErrors& errors, F step) {
    try {
        step();
    } catch (const ConfigError& e) {
        errors.push_back(e);
    }
}

// [arm] of the file at path.
void read_arm_section(const toml::table& section, const std::string& path, ArmParameterSet& arm,
                      ConfigErrors& errors);

// A number as the messages name it.
std::string number_text(double v);

}  // namespace tact
