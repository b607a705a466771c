#include "run/command_line.hpp"

#include <malloc.h>

#include <limits>

int main(int argc, char** argv) {
    // Memory that is let go of is kept for what asks next. By default the library returns large pieces to the system,
    // and the solver of a grid, whose vectors live for an iteration, spends a tenth of its time on new pages.
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    return plumb::program(argc, argv);
}
