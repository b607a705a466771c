// Ctrl-C and SIGTERM: a wish to stop, granted at the next whole step.
#pragma once

namespace plumb {

/// While an object of this class lives, the first SIGINT or SIGTERM only sets a mark; a second one ends the process.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    bool requested() const;
};

/// A full disk, a file size limit or a closed pipe must come back as an error of the call that met it, not as a signal
/// that ends the process halfway.
void ignore_output_signals();

} // namespace plumb
