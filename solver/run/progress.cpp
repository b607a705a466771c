#include "run/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace plumb {

namespace {

constexpr double redraw_interval = 0.2; // [s]
constexpr int bar_width = 20;           // [characters]

double since(std::chrono::steady_clock::time_point t) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

/// "1:02:03" or "2:03".
std::string clock_text(double seconds) {
    const auto whole = static_cast<std::int64_t>(std::llround(std::min(seconds, 3.6e9)));
    if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// A reader that has gone away does not stop a run.
void say(const std::string& text) { std::fputs(text.c_str(), stdout); }

} // namespace

Progress::Progress(bool quiet, const Run& run)
    : quiet_(quiet), terminal_(::isatty(STDOUT_FILENO) == 1), first_step_(run.simulation.grains.step) {}

std::string Progress::line(const Run& run) const {
    const std::int64_t step = run.simulation.grains.step, all = total_steps(run.simulation.timing);
    const double spent = since(start_), done = static_cast<double>(step - first_step_);
    std::string text = fmt::format("{:3} %  t = {:.6g} s  step {}", 100 * step / std::max<std::int64_t>(all, 1),
                                   run.simulation.grains.time, step);
    if (done > 0.0)
        text += fmt::format("  {:.3g} grain-steps/s  {} left", updates_ / std::max(spent, 1e-9),
                            clock_text(spent / done * static_cast<double>(all - step)));
    return text;
}

void Progress::show(const Run& run, double updates) {
    updates_ += updates;
    if (quiet_ || !terminal_ || since(drawn_) < redraw_interval) return;
    drawn_ = Clock::now();
    const std::int64_t step = run.simulation.grains.step, all = total_steps(run.simulation.timing);
    const auto filled = static_cast<std::size_t>(bar_width * step / std::max<std::int64_t>(all, 1));
    std::string bar(bar_width, ' ');
    std::fill_n(bar.begin(), filled, '=');
    const std::string text = fmt::format("[{}] {}", bar, line(run));
    say(fmt::format("\r{:<{}}", text, shown_)); // what is left of a longer line is blanked
    shown_ = text.size();
    std::fflush(stdout);
}

void Progress::show_output(const Run& run) {
    if (quiet_ || terminal_) return;
    say(fmt::format("{}\n", line(run)));
    std::fflush(stdout);
}

void Progress::end(const std::string& text) {
    if (quiet_) return;
    if (shown_ > 0) say(fmt::format("\r{:<{}}\r", "", shown_));
    say(fmt::format("{}\n", text));
    std::fflush(stdout);
}

} // namespace plumb
