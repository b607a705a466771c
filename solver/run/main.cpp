#include "run/command_line.hpp"

int main(int argc, char** argv) { return plumb::program(argc, argv); }
