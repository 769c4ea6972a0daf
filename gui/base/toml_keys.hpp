// Reads TOML files edited by hand: each key has a range and is optional; an unknown key is an error.
//
// Form     tables are one level deep: "camera.distance_a" is distance_a in [camera]
// Fails    by StartupError with the file, the line or key, the expected value, and `fix`
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
    // span: exactly this many numbers; vector: up to two numbers.
    std::variant<std::span<double>, std::vector<double>*, bool*, std::string*, TomlChoice> target;
    double low = 0.0, high = 0.0;  // range of each number
};

class TomlKeys {
public:
    TomlKeys(const std::string& file, std::string fix) : file_("'" + file + "'"), fix_(std::move(fix)) {}
    // Returns the names of the keys present.
    [[nodiscard]] std::vector<std::string> read(std::string_view text, std::span<const TomlKey> keys) const;
    [[noreturn]] void fail(const std::string& where, const std::string& why) const;

private:
    std::string file_, fix_;
};

// Returns the text of a small file. Throws StartupError if it is missing or larger than a megabyte.
[[nodiscard]] std::string read_typed_file(const std::filesystem::path& path, const std::string& fix);

}  // namespace tact
