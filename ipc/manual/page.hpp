// Man pages, section 1.
#pragma once

#include <string>
#include <vector>

#include "ipc/manual/command.hpp"
#include "ipc/manual/manual.hpp"

namespace tact::manual {

struct Page {
    std::string name, text;  // "tact-dock", and its roff
};

// The page of the program and one for each of its commands, and of theirs. A command whose page would bear the
// name of another program is described in the page above it.
//
// SOURCE_DATE_EPOCH in the environment gives the pages a date; they have none otherwise, so that the same
// source makes the same pages.
std::vector<Page> pages(const Command& program, const std::vector<File>& files);

}  // namespace tact::manual
