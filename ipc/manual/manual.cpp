#include "ipc/manual/manual.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "ipc/base/error.hpp"
#include "ipc/manual/command.hpp"
#include "ipc/manual/completion.hpp"
#include "ipc/manual/help.hpp"
#include "ipc/manual/page.hpp"

namespace tact::manual {
namespace {

void write_pages(const Command& command, const std::vector<File>& files,
                 const std::filesystem::path& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed)
        throw StartupError("creating the folder " + folder.string(), failed.message(),
                           "choose a writable folder");
    for (const Page& page : pages(command, files)) {
        const auto path = folder / (page.name + ".1");
        std::ofstream out(path, std::ios::binary);
        if (!(out << page.text) || !out.flush())
            throw StartupError("writing " + path.string(), last_error(), "choose a writable folder");
    }
}

}  // namespace

std::optional<int> answer(CLI::App& app, const std::string& program, int argc, const char* const* argv,
                          const std::vector<File>& files) {
    use_help_formatter(app);
    const std::string_view asked = argc > 1 ? argv[1] : "";
    const bool pages_asked = asked == "--manual" && argc == 3;
    if (!pages_asked && !(asked == "--completion" && argc == 2)) return std::nullopt;
    try {
        const Command command = read_command(app, {program});
        if (pages_asked) {
            write_pages(command, files, argv[2]);
        } else if (std::fputs(completion(command).c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
            throw StartupError("printing the completion", last_error(),
                               "free space at the output's destination");
        }
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s: %s\n", program.c_str(), e.what());
        return 1;
    }
}

}  // namespace tact::manual
