// Writes the state of the lattice benchmark after some steps as a table, for the peers and for comparison with them.
#include "benchmarks/benchmark_scenes.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "run/aside_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <iterator>
#include <string>

namespace plumb {

namespace {

/// One row per grain in order of creation.
std::string state_table(const GrainSystem& system) {
    const Grains& grains = system.grains;
    std::string text = "x [m], y [m], z [m], vx [m/s], vy [m/s], vz [m/s], wx [rad/s], wy [rad/s], wz [rad/s]\n";
    for (const std::int32_t place : positions_of_ids(grains)) {
        const auto k = static_cast<std::size_t>(place);
        const Vec3 x = system.domain.wrapped(grains.x[k]);
        const Vec3 &v = grains.v[k], &w = grains.omega[k];
        fmt::format_to(std::back_inserter(text),
                       "{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}\n", x[0], x[1],
                       x[2], v[0], v[1], v[2], w[0], w[1], w[2]);
    }
    return text;
}

} // namespace

} // namespace plumb

int main(int count, char** arguments) {
    try {
        char* end = nullptr;
        const long steps = count == 3 ? std::strtol(arguments[1], &end, 10) : -1;
        if (steps < 0 || end == arguments[1] || *end != '\0') {
            fmt::print(stderr, "usage: plumb_benchmark_state STEPS TABLE.csv\n");
            return 2;
        }
        plumb::set_threads(1);
        plumb::Simulation simulation = plumb::pressed_lattice();
        plumb::advance(simulation, steps);
        plumb::write_text(arguments[2], plumb::state_table(simulation.grains));
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
