// Writes the scene of tests/support/small_scene.hpp to a file, for tests of whole processes.
#include <cstdio>

#include "tests/support/small_scene.hpp"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: write_small_scene FILE\n");
        return 1;
    }
    tact::small_scene().write(argv[1]);
    return 0;
}
