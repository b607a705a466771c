#include "run/interruption.hpp"

#include <array>
#include <csignal>

namespace plumb {

namespace {

volatile std::sig_atomic_t stop_requested = 0;
constexpr std::array<int, 2> signals{SIGINT, SIGTERM};

void note(int number) {
    stop_requested = 1;
    std::signal(number, SIG_DFL);
}

} // namespace

Interruption::Interruption() {
    stop_requested = 0;
    for (const int number : signals) std::signal(number, note);
}

Interruption::~Interruption() {
    for (const int number : signals) std::signal(number, SIG_DFL);
}

bool Interruption::requested() const { return stop_requested != 0; }

void ignore_output_signals() {
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

} // namespace plumb
