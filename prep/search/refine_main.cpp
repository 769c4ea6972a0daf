// tact-refine: moves structures to the best place nearby in a density map. `tact refine` starts it.
#include "prep/search/fit_program.hpp"
#include "prep/search/refine_command.hpp"

int main(int argc, char** argv) {
    return tact::run_fit_program("tact-refine",
                                 "tact-refine: moves structures from the positions of their files to the "
                                 "best place nearby in a density map",
                                 tact::set_up_refine, argc, argv);
}
