// The section [arm] of the configuration: a model from the table in hal/arm, and parameters that override it.
#include "rt/config/config_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

struct Place {
    std::string where, key;  // file:line, arm.name
};

constexpr const char* kFix = "see hal/arm/README.md for the meaning of each key";

std::string word_of(const toml::node& node, const Place& at) {
    if (!node.is_string()) throw ConfigError(at.where, at.key, "this is not text in quotes", kFix);
    return node.value<std::string>().value_or("");
}

void set_figure(const ArmKey& key, std::size_t i, const toml::node& node, const Place& at) {
    if (!node.is_number()) throw ConfigError(at.where, at.key, "this is not a number", kFix);
    const double v = node.value<double>().value_or(0.0);
    if (!std::isfinite(v) || v < key.low || v > key.high) {
        throw ConfigError(
            at.where, at.key,
            number_text(v) + " is outside " + number_text(key.low) + " to " + number_text(key.high), kFix);
    }
    key.metrics[i] = {v, FigureSource::configured};
}

void set_parameters(const ArmKey& key, const toml::node& node, const Place& at) {
    const std::size_t most = key.metrics.size();
    if (most == 1) return set_figure(key, 0, node, at);
    const toml::array* list = node.as_array();
    const std::size_t given = list == nullptr ? 0 : list->size();
    if (given != most && !(most == 6 && given == 3)) {
        throw ConfigError(
            at.where, at.key,
            "this is not a list of " + std::string(most == 6 ? "3 or 6" : std::to_string(most)) + " numbers",
            kFix);
    }
    for (std::size_t i = 0; i < given; ++i) set_figure(key, i, (*list)[i], at);
}

}  // namespace

void read_arm_section(const toml::table& section, const std::string& path, ArmParameterSet& arm,
                      ConfigErrors& errors) {
    const auto place = [&path](const std::string& name, const toml::node& node) {
        return Place{path + ":" + std::to_string(node.source().begin.line), "arm." + name};
    };
    // The model comes first, wherever it stands in the section: the other keys overwrite its parameters.
    if (const toml::node* model = section.get("model")) {
        collect(errors, [&] {
            const Place at = place("model", *model);
            const std::string name = word_of(*model, at);
            try {
                arm = arm_parameter_set(name);
            } catch (const StartupError& e) {
                throw ConfigError(at.where, at.key, e.what(), "see also hal/arm/README.md");
            }
        });
    }
    const std::vector<ArmKey> keys = arm_keys(arm);
    const auto read = [&](const std::string& name, const toml::node& node) {
        const Place at = place(name, node);
        if (name == "wrist") {
            const std::string word = word_of(node, at);
            constexpr std::array words{"none", "sensed", "driven"};
            const auto* const found = std::find(words.begin(), words.end(), word);
            if (found == words.end()) {
                throw ConfigError(at.where, at.key,
                                  "\"" + word + R"(" is not one of "none", "sensed", "driven")", kFix);
            }
            arm.wrist = static_cast<Wrist>(found - words.begin());
            return;
        }
        std::string known;
        for (const ArmKey& k : keys) {
            if (name == k.name) return set_parameters(k, node, at);
            known += std::string(known.empty() ? "" : ", ") + k.name;
        }
        throw ConfigError(at.where, at.key, "there is no such key",
                          "remove it; the keys are model, wrist, " + known);
    };
    for (const auto& [leaf, node] : section) {
        const std::string name(leaf.str());
        if (name == "model") continue;
        collect(errors, [&, &value = node] { read(name, value); });
    }
}

}  // namespace tact
