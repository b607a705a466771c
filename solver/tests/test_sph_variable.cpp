// Smoothing lengths that follow the density: invariants, Omega against its definition, and the limit of one length.
#include "schemes/advance_fluid.hpp"

#include "fluid_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// A stirred, jittered periodic box; densities within 3 % of rho_0.
SphFluid stirred(int d, const Kernel& kernel, double share) {
    SphFluid f = empty_fluid(box_of_dimensions(d, Vec3(1.0, 1.1, 1.2), {true, true, true}), kernel, 1.3);
    f.operators = VariableOperators{};
    f.equation_of_state = LinearState{};
    f.clusters.reach *= greatest_growth(f.operators);
    put_lattice(f, {10, 11, 12}, 0.2, 5);
    stir(f, 1.0, share, 6);
    start(f);
    return f;
}

double length_of(const SphFluid& f, double rho) { return f.h * std::pow(f.density / rho, 1.0 / f.dimensions); }

/// W(r, h)
double kernel_value(const SphFluid& f, double r, double h) {
    return std::visit(
        [&](const auto& k) {
            using Law = std::decay_t<decltype(k)>;
            const double q = r / h;
            return q < Law::support ? Law::sigma(f.dimensions) / std::pow(h, f.dimensions) * Law::w(q) : 0.0;
        },
        f.kernel);
}

} // namespace

// A gradient at the wrong particle's length, or an Omega on the wrong side: momentum, and energy with du = p/rho^2
// drho, are conserved to round-off whatever Omega is, if it is used consistently.
TEST(SphVariable, ConservesMomentumAndEnergy) {
    for (const int d : {2, 3})
        for_each_law<Kernel>([&](auto kernel) {
            const SphFluid f = stirred(d, kernel, 0.03);
            Vec3 force = Vec3::Zero();
            double power = 0.0, scale = 0.0;
            for (const std::size_t k : slots_by_id(f)) {
                const Vec3 a = entry(f, f.a, k), v = entry(f, f.v, k);
                force += a;
                const double inner = pressure(f, f.rho[k]) / (f.rho[k] * f.rho[k]) * f.drho[k];
                power += v.dot(a) + inner;
                scale += std::abs(v.dot(a)) + std::abs(inner);
            }
            EXPECT_LT(force.norm(), 1e-11 * scale);
            EXPECT_LT(std::abs(power), 1e-11 * scale);
        });
}

// Omega with a lost self term, factor d, or sign.
TEST(SphVariable, OmegaIsItsDefinition) {
    for (const int d : {2, 3}) {
        const SphFluid f = stirred(d, WendlandC2{}, 0.03);
        const std::vector<std::size_t> slots = slots_by_id(f);
        for (std::size_t id = 0; id < slots.size(); id += 97) {
            const std::size_t a = slots[id];
            const double h = length_of(f, f.rho[a]), e = 1e-5 * h;
            double slope = 0.0; // sum m dW/dh
            for (const std::size_t b : slots) {
                const double r = f.domain.minimum_image(entry(f, f.x, a) - entry(f, f.x, b)).norm();
                slope += f.mass * (kernel_value(f, r, h + e) - kernel_value(f, r, h - e)) / (2.0 * e);
            }
            EXPECT_NEAR(f.lengths.omega[a], 1.0 + h / (d * f.rho[a]) * slope, 1e-7);
        }
    }
}

// Lengths that do not go back to h at rho_0: with uniform density the sums are the plain ones over Omega.
TEST(SphVariable, UniformDensityGivesThePlainSums) {
    const SphFluid variable = stirred(2, WendlandC4{}, 0.0);
    SphFluid plain = variable;
    plain.operators = PlainOperators{};
    start(plain);
    const std::vector<std::size_t> now = slots_by_id(variable), then = slots_by_id(plain);
    for (std::size_t id = 0; id < now.size(); ++id)
        EXPECT_NEAR(variable.drho[now[id]] * variable.lengths.omega[now[id]], plain.drho[then[id]], 1e-9);
}

// A reduction, or Omega that does not move with its particle when lists are renewed.
TEST(SphVariable, SameBitsForAnyNumberOfThreadsAndOrder) {
    const auto run = [](int n) {
        const Threads threads(n);
        SphFluid f = stirred(2, WendlandC2{}, 0.02);
        for (int step = 1; step <= 60; ++step) advance_fluid(f, 1e-3, step);
        return f;
    };
    const SphFluid one = run(1);
    expect_same_bits(one, run(2));
    expect_same_bits(one, run(4));
}
