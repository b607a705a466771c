// The program `plumb`.
#pragma once

namespace plumb {

/// Does what the command line says and returns the exit code of the process: 0 done, 1 `diff` found a difference,
/// 2 invalid input, 3 diverged, 4 input/output failure, 130 interrupted with a checkpoint. Every error is one line
/// "plumb: error: ..." on stderr. This is the only place where errors are caught to end the program.
int program(int argc, const char* const* argv);

} // namespace plumb
