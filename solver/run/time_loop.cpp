#include "run/time_loop.hpp"

#include "run/aside_file.hpp"
#include "run/checkpoint.hpp"
#include "run/interruption.hpp"
#include "run/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace plumb {

namespace {

// Wall times [s]: none of them changes a result.
constexpr double series_interval = 1.0;      // least time between two writings of the same series
constexpr double checkpoint_interval = 10.0; // and of a checkpoint; work worth waiting for the disk
constexpr double least_pause = 20.0;         // in times of what the last writing took: at most 5 % of a run
constexpr double chunk_time = 0.2;           // of steps between two looks at the signals

double wall_time() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Keeps a file from being written too often.
class Pace {
public:
    explicit Pace(double interval) : interval_(interval) {}
    bool due() const { return wall_time() >= next_; }
    template <class Write> void write(Write&& action) {
        const double begin = wall_time();
        action();
        const double end = wall_time();
        next_ = end + std::max(interval_, least_pause * (end - begin));
    }

private:
    double interval_;
    double next_ = 0.0;
};

/// Everything a run writes, and when.
class Output {
public:
    Output(Run& run, const ResultFolder& folder) : run_(run), folder_(folder), meter_(run.cost) {}

    void count(double updates) { meter_.add_updates(updates); }

    /// At t = 0 and after every output interval.
    void at_interval() {
        if (run_.simulation.timing.snapshots) {
            const std::int64_t number = run_.simulation.grains.step / run_.simulation.timing.steps_per_output;
            add_snapshot(snapshot_name(number));
        }
        if (series_.due()) write_series_and_index();
        if (checkpoint_.due()) write_checkpoint();
    }

    void write_all() {
        write_series_and_index();
        write_checkpoint();
    }

    /// Saves the state of a run that diverged; returns where, or why not.
    std::string write_last_state() {
        try {
            add_snapshot("snapshots/diverged.h5");
            write_series_and_index();
            return fmt::format("last state in {}", folder_.file("snapshots/diverged.h5"));
        } catch (const IoError& e) {
            return fmt::format("last state lost, {}", e.what());
        }
    }

    void write_provenance(std::optional<int> exit) {
        write_text(folder_.file("run.json"),
                   provenance_json(run_.scene, run_.simulation, run_.start, meter_.now(), exit));
    }

    Cost cost() const { return meter_.now(); }

private:
    void add_snapshot(const std::string& name) {
        make_folder(folder_.file("snapshots"));
        write_snapshot(folder_.file(name), run_.simulation);
        unflushed_.push_back(name);
        run_.snapshots.push_back({name, static_cast<double>(run_.simulation.grains.step) * run_.simulation.timing.dt,
                                  run_.simulation.grains.grains.size(), fluid_count(run_.simulation)});
    }
    void write_series_and_index() {
        series_.write([&] {
            write_series(folder_.file("series.h5"), run_.probes);
            if (!run_.snapshots.empty()) write_xdmf(folder_.file("result.xdmf"), run_.snapshots);
        });
    }
    void write_checkpoint() {
        checkpoint_.write([&] {
            save_checkpoint(folder_.file("checkpoint.h5"), run_, meter_.now());
            if (wall_time() - flushed_ < checkpoint_interval) return; // too little to lose
            for (const std::string& name : unflushed_) flush_to_disk(folder_.file(name));
            flush_to_disk(folder_.file("checkpoint.h5"));
            unflushed_.clear();
            flushed_ = wall_time();
        });
    }

    Run& run_;
    const ResultFolder& folder_;
    CostMeter meter_;
    Pace series_{series_interval};
    Pace checkpoint_{checkpoint_interval};
    double flushed_ = wall_time();       // when the state was last safe from a power cut
    std::vector<std::string> unflushed_; // snapshots written since
};

/// Takes the run to step `goal`, or less far if it is to be interrupted, a short time after another.
class Stepper {
public:
    void advance_to(std::int64_t goal, Run& run, Output& output, Progress& progress, const Interruption& interruption) {
        while (run.simulation.grains.step < goal && !interruption.requested()) {
            const std::int64_t steps = std::min(goal - run.simulation.grains.step, chunk_);
            const double begin = wall_time();
            advance(run.simulation, steps);
            const double spent = std::max(wall_time() - begin, 1e-9);
            const double updates = static_cast<double>(steps) * static_cast<double>(item_count(run.simulation));
            output.count(updates);
            progress.show(run, updates);
            const double affordable = static_cast<double>(steps) * chunk_time / spent;
            chunk_ = std::max<std::int64_t>(
                1, static_cast<std::int64_t>(std::min(affordable, 4.0 * static_cast<double>(chunk_))));
        }
    }

private:
    std::int64_t chunk_ = 1;
};

/// The loop itself. True if it came to the end.
bool run_steps(Run& run, Output& output, Progress& progress, const Interruption& interruption) {
    Stepper stepper;
    const Timing& timing = run.simulation.timing;
    const std::int64_t end = total_steps(timing);
    const std::int64_t& step = run.simulation.grains.step;
    const auto at_event = [&] {
        record(run.probes, run.simulation);
        if (step % timing.steps_per_output != 0) return;
        output.at_interval();
        progress.show_output(run);
    };
    if (!run.begun) at_event();
    run.begun = true;
    while (step < end) {
        const std::int64_t next_output = (step / timing.steps_per_output + 1) * timing.steps_per_output;
        const std::int64_t event = next_record(run.probes, step, std::min(next_output, end));
        stepper.advance_to(event, run, output, progress, interruption);
        if (step == event) at_event();
        if (interruption.requested() && step < end) return false;
    }
    return true;
}

std::string closing_line(const Run& run, const ResultFolder& folder, const Cost& cost) {
    std::string text = fmt::format("done: {} steps, {:.4g} s wall time, {:.4g} s CPU, results in {}",
                                   run.simulation.grains.step, cost.wall_s, cost.cpu_s, folder.path());
    if (!run.simulation.fluid) return text;
    const RangeUse& use = run.simulation.fluid->range_use;
    if (use.outside > 0)
        text += fmt::format("\ndrag law {} was used outside the range of its source in {:.2g} % of its evaluations "
                            "(superficial Re {:.3g} to {:.3g})",
                            law_name(run.simulation.fluid->drag),
                            100.0 * static_cast<double>(use.outside) / static_cast<double>(use.inside + use.outside),
                            use.re_min, use.re_max);
    if (use.dry > 0)
        text +=
            fmt::format("\ngrains had no fluid in reach in {:.2g} % of the steps, and fell freely",
                        100.0 * static_cast<double>(use.dry) / static_cast<double>(use.inside + use.outside + use.dry));
    return text;
}

} // namespace

ExitCode run_to_end(Run& run, const ResultFolder& folder, bool quiet) {
    Output output(run, folder);
    Progress progress(quiet, run);
    const Interruption interruption;
    const auto close = [&](ExitCode code) {
        output.write_provenance(static_cast<int>(code));
        return code;
    };
    try {
        output.write_provenance(std::nullopt);
        const bool complete = run_steps(run, output, progress, interruption);
        output.write_all();
        progress.end(complete ? closing_line(run, folder, output.cost())
                              : fmt::format("stopped at t = {:.6g} s", run.simulation.grains.time));
        return close(complete ? ExitCode::done : ExitCode::interrupted);
    } catch (const Diverged& e) {
        const std::string where = output.write_last_state();
        progress.end(fmt::format("stopped at t = {:.6g} s", run.simulation.grains.time));
        try {
            close(ExitCode::diverged);
        } catch (const IoError&) { // the divergence is the news
        }
        throw Diverged(e.step, e.time, e.field, e.index, e.value, e.likely_limit + "; " + where);
    } catch (const IoError&) {
        try {
            close(ExitCode::io_failure);
        } catch (const IoError&) { // most likely for the same reason, which is on its way already
        }
        throw;
    }
}

} // namespace plumb
