// Keys of a TOML file that a person may type: each has a range, every one may be left out, and another is an error.
//
// Form     tables are one deep: "camera.distance_a" is distance_a in [camera]
// Fails    by StartupError that names the file, the line or the key, what is wanted there, and `fix`
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tact {

struct TomlChoice {
    int* target;
    std::span<const char* const> names;
};

struct TomlKey {
    const char* name;
    // As many numbers as there are; up to two.
    std::variant<std::span<double>, std::vector<double>*, bool*, std::string*, TomlChoice> target;
    double low = 0.0, high = 0.0;  // of each number
};

class TomlKeys {
public:
    TomlKeys(const std::string& file, std::string fix) : file_("'" + file + "'"), fix_(std::move(fix)) {}
    // Those that were there.
    [[nodiscard]] std::vector<std::string> read(std::string_view text, std::span<const TomlKey> keys) const;
    [[noreturn]] void fail(const std::string& where, const std::string& why) const;

private:
    std::string file_, fix_;
};

// A small file as it is. Fails by StartupError: it is not there, or larger than a megabyte.
[[nodiscard]] std::string read_typed_file(const std::filesystem::path& path, const std::string& fix);

}  // namespace tact
