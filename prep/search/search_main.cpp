// tact-search: finds the places of structures in a density map. `tact search` starts it.
#include "prep/search/fit_program.hpp"
#include "prep/search/search_command.hpp"

int main(int argc, char** argv) {
    return tact::run_fit_program(
        "tact-search",
        "tact-search: finds the places of structures in a density map, and lists the best of each",
        tact::set_up_search, argc, argv);
}
