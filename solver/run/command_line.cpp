#include "run/command_line.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "run/check.hpp"
#include "run/checkpoint.hpp"
#include "run/diff.hpp"
#include "run/interruption.hpp"
#include "run/law_list.hpp"
#include "run/time_loop.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

namespace plumb {

namespace {

constexpr int most_threads = 1024; // more is a slip of the pen

/// What was asked for.
struct Options {
    std::string scene, folder, other_folder;
    std::vector<std::string> overrides;
    int threads = 0; // 0: as the environment says
    bool quiet = false, json = false;
};

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw IoError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
}

ExitCode finish_run(Run& run, const ResultFolder& folder, bool quiet) {
    const ExitCode code = run_to_end(run, folder, quiet);
    if (code == ExitCode::interrupted)
        std::fputs(fmt::format("plumb: interrupted after step {} at t = {:.6g} s; go on with: plumb resume {}\n",
                               run.simulation.grains.step, run.simulation.grains.time, folder.path())
                       .c_str(),
                   stderr);
    return code;
}

ExitCode run_scene(const Options& options) {
    std::string path = options.folder;
    if (path.empty()) path = std::filesystem::path(options.scene).stem().string() + ".out";
    Run run = make_run(load_scene(options.scene, options.overrides));
    const ResultFolder folder = ResultFolder::fresh(path);
    return finish_run(run, folder, options.quiet);
}

ExitCode resume(const Options& options) {
    const ResultFolder folder = ResultFolder::existing(options.folder);
    if (!std::filesystem::exists(folder.file("checkpoint.h5")))
        throw InputError(fmt::format("{}: there is no checkpoint to resume from", options.folder));
    Run run = load_checkpoint(folder.file("checkpoint.h5"));
    return finish_run(run, folder, options.quiet);
}

ExitCode check(const Options& options) {
    print(check_report(make_run(load_scene(options.scene, options.overrides)), options.json));
    return ExitCode::done;
}

int compare(const Options& options) {
    const Comparison comparison = difference(options.folder, options.other_folder);
    print((comparison.same ? "" : "different: ") + comparison.text + "\n");
    return comparison.same ? 0 : 1;
}

void add_scene_options(CLI::App& command, Options& options) {
    command.add_option("scene", options.scene, "Scene file (TOML)")->required();
    command
        .add_option("--set", options.overrides,
                    "Change the scene: key.path=value, the value as in TOML; "
                    "grains.0.diameter=1e-3 reaches into a list of tables")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

void add_run_options(CLI::App& command, Options& options) {
    command.add_option("--threads", options.threads, "Number of threads; results do not depend on it")
        ->check(CLI::Range(1, most_threads));
    command.add_flag("--quiet", options.quiet, "No progress");
}

/// Describes the command line; returns the commands in the order run, check, resume, diff, laws.
std::vector<CLI::App*> add_commands(CLI::App& app, Options& options) {
    app.set_version_flag("--version", version_text());
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run", "Run a scene and write its results to a folder");
    add_scene_options(*run, options);
    run->add_option("-o,--output", options.folder,
                    "Result folder (default: <scene>.out here). The files of an older result in it are removed first, "
                    "other files stay; a folder that holds something else only is refused");
    add_run_options(*run, options);
    CLI::App* check_command =
        app.add_subcommand("check", "Validate a scene and print derived numbers, step limits and predicted cost");
    add_scene_options(*check_command, options);
    check_command->add_flag("--json", options.json, "Print JSON");
    CLI::App* resume_command = app.add_subcommand("resume", "Continue an interrupted run from its last checkpoint");
    resume_command->add_option("folder", options.folder, "Result folder")->required();
    add_run_options(*resume_command, options);
    CLI::App* diff = app.add_subcommand("diff", "Compare two results bit by bit: exit code 0 the same, 1 different");
    diff->add_option("a", options.folder, "Result folder")->required();
    diff->add_option("b", options.other_folder, "Result folder")->required();
    CLI::App* laws = app.add_subcommand("laws", "List all laws with formula, range and source");
    laws->add_flag("--json", options.json, "Print JSON");
    app.footer("Exit codes: 0 done, 1 results differ (diff), 2 invalid input, 3 diverged, 4 input/output failure, "
               "130 interrupted with a checkpoint.");
    return {run, check_command, resume_command, diff, laws};
}

int dispatch(int argc, const char* const* argv) {
    CLI::App app{"plumb: grains in a fluid, with a verdict", "plumb"};
    Options options;
    const std::vector<CLI::App*> commands = add_commands(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app.exit(e); // help and version
        throw InputError(e.what());
    }
    if (options.threads > 0) set_threads(options.threads);
    if (*commands[0]) return static_cast<int>(run_scene(options));
    if (*commands[1]) return static_cast<int>(check(options));
    if (*commands[2]) return static_cast<int>(resume(options));
    if (*commands[3]) return compare(options);
    print(law_list(options.json));
    return 0;
}

int report(const std::string& what, ExitCode code) {
    std::string line = "plumb: error: " + what;
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' '; // whatever a file put there, it is one line
    std::fputs((line + "\n").c_str(), stderr);
    return static_cast<int>(code);
}

} // namespace

int program(int argc, const char* const* argv) {
    ignore_output_signals();
    try {
        return dispatch(argc, argv);
    } catch (const InputError& e) {
        return report(e.what(), ExitCode::invalid_input);
    } catch (const Diverged& e) {
        return report(e.what(), ExitCode::diverged);
    } catch (const IoError& e) {
        return report(e.what(), ExitCode::io_failure);
    } catch (const std::bad_alloc&) {
        return report("not enough memory", ExitCode::io_failure);
    } catch (const std::exception& e) {
        return report(fmt::format("unexpected: {}", e.what()), ExitCode::io_failure);
    }
}

} // namespace plumb
