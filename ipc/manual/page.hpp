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

// One page for the program and for each of its commands, recursively. A command whose page would have the
// name of another program's page is described in the page of its parent.
//
// SOURCE_DATE_EPOCH in the environment sets the date of the pages; without it they have none, so that the
// same source gives the same pages.
std::vector<Page> pages(const Command& program, const std::vector<File>& files);

}  // namespace tact::manual
