// --help in the same words as the man pages: value, range and default of every option, nothing of the parser's internals.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <string>

namespace tact::manual {

class HelpFormatter final : public CLI::Formatter {
public:
    // Behind the names: "HZ (1 to 10000; default 1000)".
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
};

// For the program and all of its commands.
void use_help_formatter(CLI::App& app);

}  // namespace tact::manual
