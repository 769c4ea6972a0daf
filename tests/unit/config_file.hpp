// A configuration file of the tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ipc/base/error.hpp"
#include "rt/config/config.hpp"

namespace tact::test {

class TempFile {
public:
    explicit TempFile(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("tact_config_" + std::to_string(getpid()) + ".toml")) {
        std::ofstream(path_) << text;
    }
    ~TempFile() { std::filesystem::remove(path_); }
    [[nodiscard]] std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

// The error of a file with this text; empty if valid.
inline std::string error_of(const std::string& text) {
    const TempFile file(text);
    RtConfig config;
    try {
        read_config(file.path(), config);
    } catch (const StartupError& e) {
        return e.what();
    }
    return {};
}

}  // namespace tact::test
