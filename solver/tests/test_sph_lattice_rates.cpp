// The greatest rates of the sums over neighbours, against the sums themselves: every wave of a small box that moves
// along its own direction is put into the particles, and its rate read off.
#include "schemes/advance_fluid.hpp"
#include "schemes/simulation.hpp"
#include "schemes/sph_scene.hpp"
#include "sph/lattice_rates.hpp"

#include "fluid_fixtures.hpp"

#include <fmt/format.h>

#include <string>

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// A square or cube of n^d particles, spacing 1 m, nu = 1 m2/s, at rest on their lattice.
Simulation resting(int n, int d, const std::string& kernel, double smoothing, const std::string& term) {
    const std::string sides = d == 2 ? fmt::format("[{0}.0, {0}.0]", n) : fmt::format("[{0}.0, {0}.0, {0}.0]", n);
    const std::string text = fmt::format(R"([domain]
size = {}
periodic = {}
gravity = {}
[fluid]
method = "sph"
density = 1.0
viscosity = 1.0
spacing = 1.0
smoothing = {}
kernel = "{}"
operators = "plain"
equation_of_state = "linear"
sound_speed = 1.0
pressure = "full"
viscous_term = "{}"
shifting = 1.0
reference_velocity = 1.0
arrange = {{law = "lattice"}}
initial = {{law = "rest"}}
[time]
end = 1.0
output_interval = 1.0
integrator = "midpoint"
step = 1.0
)",
                                         sides, d == 2 ? "[true, true]" : "[true, true, true]",
                                         d == 2 ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]", smoothing, kernel, term);
    Scene scene = scene_from_text(text, "scene.toml", "/");
    return make_simulation(scene);
}

enum class Moved { velocity, position };

/// Rate of the longitudinal wave with `waves` lengths along each axis: minus the response over the wave.
double rate_of_wave(SphFluid& f, const Vec3& waves, Moved moved) {
    constexpr double amplitude = 1e-6;
    const Vec3 k = 2.0 * std::numbers::pi / f.domain.size[0] * waves, along = k.normalized();
    const auto axes = static_cast<std::size_t>(f.dimensions);
    const auto shape = [&](std::size_t s) {
        double phase = 0.7;
        for (std::size_t c = 0; c < axes; ++c) phase += k[static_cast<Eigen::Index>(c)] * (std::floor(f.x[c][s]) + 0.5);
        return std::cos(phase);
    };
    for (std::size_t s = 0; s < f.slots(); ++s)
        for (std::size_t c = 0; c < axes; ++c) {
            const double part = amplitude * along[static_cast<Eigen::Index>(c)] * shape(s),
                         site = std::floor(f.x[c][s]) + 0.5;
            f.x[c][s] = site + (moved == Moved::position ? part : 0.0);
            f.v[c][s] = moved == Moved::velocity ? part : 0.0;
        }
    start(f);
    const VectorField& response = moved == Moved::velocity ? f.a : f.spread;
    double answered = 0.0, put_in = 0.0;
    for (std::size_t s = 0; s < f.slots(); ++s) {
        for (std::size_t c = 0; c < axes; ++c)
            answered -= shape(s) * along[static_cast<Eigen::Index>(c)] * response[c][s];
        put_in += amplitude * shape(s) * shape(s);
    }
    return answered / put_in;
}

/// Greatest rate of all longitudinal waves of a cube of n particles a side.
double greatest_of_waves(SphFluid& f, int n, Moved moved) {
    double greatest = 0.0;
    for (int i = 1; i <= n / 2; ++i)
        for (int j = 0; j <= i; ++j)
            for (int l = 0; l <= (f.dimensions == 3 ? j : 0); ++l)
                greatest = std::max(greatest, rate_of_wave(f, Vec3(i, j, l), moved));
    return greatest;
}

} // namespace

// A viscous limit from the mean over directions and phases: forms along the line of centres damp short longitudinal
// waves up to 1.6 times faster, and their scenes would diverge at the default step.
TEST(SphLatticeRates, ViscousTermsAlongTheLineOfCentres) {
    for (const std::string term : {"monaghan_gingold", "cleary"})
        for (const auto& [kernel, smoothing] : {std::pair("wendland_c2", 1.5), std::pair("cubic_spline", 1.3)})
            for (const int d : {2, 3}) {
                const int n = d == 2 ? 20 : 10;
                Simulation s = resting(n, d, kernel, smoothing, term);
                const double greatest = greatest_of_waves(*s.sph, n, Moved::velocity);
                EXPECT_NEAR(greatest_viscous_rate(*s.sph) / greatest, 1.0, 0.02) << term << kernel << d;
            }
}

// A wrong Hessian, or the cosine forgotten: every wave of displacements, read off the shifts that the sums propose.
TEST(SphLatticeRates, Concentration) {
    for (const auto& [kernel, smoothing] : {std::pair("wendland_c2", 2.0), std::pair("quintic_spline", 1.3)})
        for (const int d : {2, 3}) {
            const int n = d == 2 ? 20 : 10;
            Simulation s = resting(n, d, kernel, smoothing, "morris");
            const double greatest = greatest_of_waves(*s.sph, n, Moved::position);
            EXPECT_NEAR(greatest_concentration_rate(*s.sph) / greatest, 1.0, 0.02) << kernel << d;
            EXPECT_NEAR(fluid_limits(*s.sph)[2].seconds, 1.0 / (s.sph->shifting * greatest_concentration_rate(*s.sph)),
                        1e-12);
        }
}
