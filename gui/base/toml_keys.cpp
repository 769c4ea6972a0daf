#include "gui/base/toml_keys.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr std::uintmax_t kBytesMost = 1U << 20;

struct Setting {
    const TomlKeys& file;
    const TomlKey& key;
    const toml::node& node;

    [[nodiscard]] double number(const toml::node& one) const {
        const auto value = one.value<double>();
        if (!value || !(*value >= key.low && *value <= key.high))
            file.fail(key.name, ": must be a number from " + std::to_string(key.low) + " to " +
                                    std::to_string(key.high));
        return *value;
    }
    void operator()(const std::span<double>& numbers) const {
        const toml::array* const array = node.as_array();
        if (numbers.size() == 1 && array == nullptr) {
            numbers[0] = number(node);
            return;
        }
        if (array == nullptr || array->size() != numbers.size())
            file.fail(key.name, ": must be a list of " + std::to_string(numbers.size()) + " numbers");
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = number((*array)[i]);
    }
    void operator()(std::vector<double>* list) const {
        const toml::array* const array = node.as_array();
        if (array == nullptr || array->size() > 2)
            file.fail(key.name, ": must be a list of up to two numbers");
        list->clear();
        for (const toml::node& each : *array) list->push_back(number(each));
    }
    void operator()(bool* flag) const {
        const auto value = node.value_exact<bool>();
        if (!value) file.fail(key.name, ": must be true or false");
        *flag = *value;
    }
    [[nodiscard]] std::string text() const {
        auto value = node.value_exact<std::string>();
        if (!value) file.fail(key.name, ": must be a string");
        return *value;
    }
    void operator()(std::string* target) const { *target = text(); }
    void operator()(const TomlChoice& choice) const {
        const std::string given = text();
        const auto found = std::find(choice.names.begin(), choice.names.end(), given);
        if (found == choice.names.end()) {
            std::string all;
            for (const char* const each : choice.names) all += (all.empty() ? "" : ", ") + std::string(each);
            file.fail(key.name, ": '" + given + "' is none of " + all);
        }
        *choice.target = static_cast<int>(found - choice.names.begin());
    }
};

void read_table(const TomlKeys& file, const toml::table& table, const std::string& prefix,
                std::span<const TomlKey> keys, std::vector<std::string>& there) {
    for (const auto& [name, node] : table) {
        const std::string full = prefix + std::string(name.str());
        if (const toml::table* const inner = node.as_table(); inner != nullptr && prefix.empty()) {
            read_table(file, *inner, full + ".", keys, there);
            continue;
        }
        const auto key =
            std::find_if(keys.begin(), keys.end(), [&](const TomlKey& k) { return full == k.name; });
        if (key == keys.end()) file.fail(full, ": there is no such key");
        std::visit(Setting{file, *key, node}, key->target);
        there.push_back(full);
    }
}

}  // namespace

void TomlKeys::fail(const std::string& where, const std::string& why) const {
    throw StartupError("reading " + file_, where + why, fix_);
}

std::vector<std::string> TomlKeys::read(std::string_view text, std::span<const TomlKey> keys) const {
    toml::table table;
    try {
        table = toml::parse(text);
    } catch (const toml::parse_error& e) {
        fail("line " + std::to_string(e.source().begin.line) + ": ", std::string(e.description()));
    }
    std::vector<std::string> there;
    read_table(*this, table, "", keys, there);
    return there;
}

std::string read_typed_file(const std::filesystem::path& path, const std::string& fix) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error || bytes > kBytesMost)
        throw StartupError("reading '" + path.string() + "'",
                           error ? error.message() : "it is larger than a megabyte", fix);
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace tact
