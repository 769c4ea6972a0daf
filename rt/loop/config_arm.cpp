// The section [arm] of the configuration: a model of the table in hal/arm, and figures of one's own arm over
// it.
#include "rt/loop/config_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

constexpr const char* kMend = "hal/arm/README.md says what each key means";

std::string word_of(const toml::node& node, const std::string& where) {
    if (!node.is_string()) throw StartupError(where, "this is not a text in quotes", kMend);
    return node.value<std::string>().value_or("");
}

void set_figure(const ArmKey& key, std::size_t i, const toml::node& node, const std::string& where) {
    if (!node.is_number()) throw StartupError(where, "this is not a number", kMend);
    const double v = node.value<double>().value_or(0.0);
    if (!std::isfinite(v) || v < key.low || v > key.high) {
        throw StartupError(
            where, number_text(v) + " is outside " + number_text(key.low) + " to " + number_text(key.high),
            kMend);
    }
    key.figures[i] = {v, FigureSource::configured};
}

void set_figures(const ArmKey& key, const toml::node& node, const std::string& where) {
    const std::size_t most = key.figures.size();
    if (most == 1) return set_figure(key, 0, node, where);
    const toml::array* list = node.as_array();
    const std::size_t given = list == nullptr ? 0 : list->size();
    if (given != most && !(most == 6 && given == 3)) {
        throw StartupError(
            where,
            "this is not a list of " + std::string(most == 6 ? "3 or 6" : std::to_string(most)) + " numbers",
            kMend);
    }
    for (std::size_t i = 0; i < given; ++i) set_figure(key, i, (*list)[i], where);
}

}  // namespace

void read_arm_section(const toml::table& section, const std::string& path, ArmFigures& arm) {
    const auto at = [&path](const std::string& name, const toml::node& node) {
        return path + ":" + std::to_string(node.source().begin.line) + ": arm." + name;
    };
    // The model first, wherever it stands: the other keys overwrite its figures.
    if (const toml::node* model = section.get("model")) {
        const std::string where = at("model", *model), name = word_of(*model, where);
        try {
            arm = arm_figures(name);
        } catch (const StartupError& e) {
            throw StartupError(where, e.what(), "see also hal/arm/README.md");
        }
    }
    const std::vector<ArmKey> keys = arm_keys(arm);
    for (const auto& [leaf, node] : section) {
        const std::string name(leaf.str()), where = at(name, node);
        if (name == "model") continue;
        if (name == "wrist") {
            const std::string word = word_of(node, where);
            constexpr std::array words{"none", "sensed", "driven"};
            const auto* const found = std::find(words.begin(), words.end(), word);
            if (found == words.end()) {
                throw StartupError(where, "\"" + word + R"(" is none of "none", "sensed", "driven")", kMend);
            }
            arm.wrist = static_cast<Wrist>(found - words.begin());
            continue;
        }
        const ArmKey* key = nullptr;
        std::string known;
        for (const ArmKey& k : keys) {
            if (name == k.name) key = &k;
            known += std::string(known.empty() ? "" : ", ") + k.name;
        }
        if (key == nullptr) {
            throw StartupError(where, "there is no such key", "remove it; there are model, wrist, " + known);
        }
        set_figures(*key, node, where);
    }
}

}  // namespace tact
