// Formats --help like the man pages: value, range and default of every option, without the parser's internals.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <string>

namespace tact::manual {

class HelpFormatter final : public CLI::Formatter {
public:
    // Text after the names: "HZ (1 to 10000; default 1000)".
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
};

// For the program and all of its commands.
void use_help_formatter(CLI::App& app);

}  // namespace tact::manual
