#include "rt/start/run_text.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/version/version.hpp"

namespace tact {
namespace {

template <std::size_t N>
std::uint32_t keep_text(const std::string& text, char (&to)[N]) {
    if (text.size() > N) return RunText::kTooLong;
    std::memcpy(to, text.data(), text.size());
    return static_cast<std::uint32_t>(text.size());
}

template <std::size_t N>
std::uint32_t keep_file(const std::string& path, char (&to)[N]) {
    if (path.empty()) return 0;
    std::ifstream in(path, std::ios::binary);
    std::string text(N + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (in.bad() || in.gcount() == 0) return RunText::kTooLong;
    text.resize(static_cast<std::size_t>(in.gcount()));
    return keep_text(text, to);
}

}  // namespace

void tell_how_started(std::span<char* const> arguments, const StartOptions& options, RunText& text) {
    std::string all;
    for (const char* const argument : arguments) all.append(argument).push_back('\0');
    if (!options.resume.empty() && options.resume_identity.empty())
        for (const std::string& word : {std::string("--resume-identity"), file_identity(options.resume)})
            all.append(word).push_back('\0');
    text.arguments_bytes = keep_text(all, text.arguments);
    text.config_bytes = keep_file(options.config, text.config);
    text.poses_bytes = keep_file(options.poses, text.poses);
    const std::string build = program_version("tact-rt");
    build.copy(text.program, sizeof text.program - 1);
}

}  // namespace tact
