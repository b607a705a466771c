// Accelerations and density rates of smoothed particles against sums written out from the formulas.
#include "schemes/advance_fluid.hpp"

#include "fluid_fixtures.hpp"

#include <algorithm>
#include <string>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double pi = std::numbers::pi;

/// What the formulas give for one particle, and the sums of absolute values as measures of rounding.
struct Rates {
    Vec3 a = Vec3::Zero(), spread = Vec3::Zero(), grad_rho = Vec3::Zero();
    Eigen::Matrix3d grad_v = Eigen::Matrix3d::Zero(); // row: component of the velocity
    double drho = 0.0;
    double a_scale = 0.0, drho_scale = 0.0, spread_scale = 0.0, grad_v_scale = 0.0, grad_rho_scale = 0.0;
};

/// Strengths of the optional terms as a scene gives them.
struct Strengths {
    double delta = 0.0, alpha = 0.0;
    bool shifting = false;
};

void set_extras(SphFluid& f, const Strengths& s) {
    f.extras.diffusion = 2.0 * s.delta * f.h * f.sound_speed;
    f.extras.artificial = s.alpha * f.sound_speed * f.h / f.mass;
    f.extras.softening_sq = 0.01 * f.h * f.h;
    f.shifting = s.shifting ? f.h * f.sound_speed : 0.0;
}

void set_viscosity(SphFluid& f, const ViscousTerm& law, double mu) {
    f.viscosity = mu;
    f.viscous_term =
        std::visit([&](const auto& l) { return ViscousTerm(std::decay_t<decltype(l)>(term_scales(f))); }, law);
}

/// Viscous acceleration of a by b, as the laws describe it.
Vec3 viscous(const SphFluid& f, double rho_a, double rho_b, const Vec3& dx, const Vec3& dv, const Vec3& grad) {
    const double scale = f.mass * f.viscosity / (rho_a * rho_b);
    const double soft = dv.dot(dx) / (dx.squaredNorm() + 0.01 * f.h * f.h);
    const std::string name = law_name(f.viscous_term);
    if (name == "morris") return 2.0 * scale * dx.dot(grad) / dx.squaredNorm() * dv;
    if (name == "monaghan_gingold") return 2.0 * (f.dimensions + 2) * scale * soft * grad;
    if (name == "cleary") return 2.0 * 4.96333 * scale * soft * grad;
    EXPECT_EQ(name, "none") << "write the formula of the new law here";
    return Vec3::Zero();
}

double slope(const SphFluid& f, double r) { // dW/dr
    const double q = r / f.h;
    return std::visit(
        [&](const auto& k) { return k.sigma(f.dimensions) / std::pow(f.h, f.dimensions + 1) * q * k.f(q); }, f.kernel);
}

/// All terms of particle a by b, one pair at a time.
void add_pair(const SphFluid& f, const Strengths& s, std::size_t a, std::size_t b, Rates& sum) {
    const Vec3 dx = f.domain.minimum_image(entry(f, f.x, a) - entry(f, f.x, b));
    const double r = dx.norm();
    if (r >= f.clusters.reach) return;
    const Vec3 dv = entry(f, f.v, a) - entry(f, f.v, b), grad = slope(f, r) / r * dx;
    const double rho_a = f.rho[a], rho_b = f.rho[b];
    const auto accelerate = [&](const Vec3& by) { sum.a += by, sum.a_scale += by.norm(); };
    const auto densify = [&](double by) { sum.drho += by, sum.drho_scale += std::abs(by); };
    const double v_a = f.mass / rho_a, v_b = f.mass / rho_b;
    if (std::holds_alternative<VolumeWeightedOperators>(f.operators)) {
        densify(rho_a * v_b * dv.dot(grad));
        accelerate(-v_a * v_b / f.mass * pressure(f, rho_a) * grad);
        accelerate(-v_a * v_b / f.mass * pressure(f, rho_b) * grad);
    } else {
        densify(f.mass * dv.dot(grad));
        accelerate(-f.mass * (pressure(f, rho_a) / (rho_a * rho_a)) * grad);
        accelerate(-f.mass * (pressure(f, rho_b) / (rho_b * rho_b)) * grad);
    }
    accelerate(viscous(f, rho_a, rho_b, dx, dv, grad));
    densify(2.0 * s.delta * f.h * f.sound_speed * (rho_b - rho_a) * (-dx).dot(grad) / (r * r) * f.mass / rho_b);
    if (dv.dot(dx) < 0.0)
        accelerate(f.mass * s.alpha * f.sound_speed * f.h * 0.5 * (1.0 / rho_a + 1.0 / rho_b) * dv.dot(dx) /
                   (r * r + 0.01 * f.h * f.h) * grad);
    const Vec3 per_volume = f.mass / rho_b * grad; // gradients by differences, and that of the concentration
    sum.spread -= per_volume, sum.spread_scale += per_volume.norm();
    sum.grad_v += -dv * per_volume.transpose(), sum.grad_v_scale += dv.norm() * per_volume.norm();
    sum.grad_rho += (rho_b - rho_a) * per_volume, sum.grad_rho_scale += std::abs(rho_b - rho_a) * per_volume.norm();
}

/// Every particle, copies too, against the sums over all pairs.
void expect_rates_of_formulas(SphFluid& f, const Strengths& s) {
    set_extras(f, s);
    start(f);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        Rates sum;
        for (std::size_t b = 0; b < f.slots(); ++b)
            if (f.id[b] >= 0 && entry(f, f.x, b) != entry(f, f.x, k)) add_pair(f, s, k, b, sum);
        sum.a += f.body_force;
        ASSERT_LT((entry(f, f.a, k) - sum.a).norm(), 1e-12 * (sum.a_scale + f.body_force.norm())) << "slot " << k;
        ASSERT_NEAR(f.drho[k], sum.drho, 1e-12 * sum.drho_scale) << "slot " << k;
        if (!s.shifting) continue;
        ASSERT_LT((entry(f, f.spread, k) - sum.spread).norm(), 1e-12 * sum.spread_scale) << "slot " << k;
        ASSERT_LT((entry(f, f.dv_spread, k) - sum.grad_v * sum.spread).norm(),
                  1e-12 * sum.grad_v_scale * sum.spread_scale)
            << "slot " << k;
        ASSERT_NEAR(f.drho_spread[k], sum.grad_rho.dot(sum.spread), 1e-12 * sum.grad_rho_scale * sum.spread_scale)
            << "slot " << k;
    }
}

/// Disordered particles with random velocities and densities in a box of n spacings.
SphFluid stirred(int dimensions, const Kernel& kernel, std::array<bool, 3> periodic, std::array<int, 3> n) {
    SphFluid f = empty_fluid(box_of_dimensions(dimensions, 0.1 * Vec3(n[0], n[1], n[2]), periodic), kernel, 1.3);
    put_lattice(f, n, 0.3, 11);
    stir(f, 2.0, 0.05, 12);
    return f;
}

constexpr std::array<bool, 3> everywhere{true, true, true}, nowhere{};
std::array<int, 3> cells_for(const Kernel& kernel) { // periodic boxes as small as each kernel allows, and no cube
    return support(kernel) > 2.5 ? std::array{9, 11, 9} : std::array{6, 9, 7};
}

Vec3 sum_of(const SphFluid& f, const VectorField& field) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) sum += entry(f, field, k);
    return sum;
}
double largest(const SphFluid& f, const VectorField& field) {
    double most = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) most = std::max(most, entry(f, field, k).norm());
    return most;
}

constexpr Strengths all_extras{0.1, 0.2, true};

} // namespace

// A wrong sign, factor, dimension or component in any term, or a pair across a side with the wrong image.
TEST(SphSweep, TermsAreThoseOfTheFormulas) {
    for (const int d : {2, 3})
        for_each_law<Kernel>([&](auto kernel) {
            for_each_law<PairViscousTerm>([&](auto law) {
                SCOPED_TRACE(testing::Message() << d << " dimensions, " << kernel.name << ", " << law.name);
                SphFluid f = stirred(d, kernel, everywhere, cells_for(kernel));
                f.body_force = d == 2 ? Vec3(0.3, -9.8, 0.0) : Vec3(0.3, 0.7, -9.8);
                set_viscosity(f, law, law.name == "none" ? 0.0 : 3.0);
                expect_rates_of_formulas(f, {});
            });
        });
}

// A mass left where a volume should be, with rooms that differ by a factor.
TEST(SphSweep, VolumesAreThoseOfTheFormulas) {
    for (const int d : {2, 3})
        for (const Strengths& s : {Strengths{}, all_extras}) {
            SphFluid f = stirred(d, WendlandC2{}, everywhere, cells_for(WendlandC2{}));
            f.operators = VolumeWeightedOperators{};
            for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] *= f.id[k] % 3 == 0 ? 0.4 : 1.0;
            set_viscosity(f, MonaghanGingold{}, 3.0);
            expect_rates_of_formulas(f, s);
        }
}

// An optional term that leaks into another one, or is on when its own coefficient is zero.
TEST(SphSweep, ExtrasAreThoseOfTheFormulas) {
    for (const int d : {2, 3})
        for_each_law<Kernel>([&](auto kernel) {
            for (const Strengths& s :
                 {Strengths{0.1, 0.0, false}, Strengths{0.0, 0.2, false}, Strengths{0.0, 0.0, true}, all_extras}) {
                if (d == 3 && !s.shifting) continue; // the rest is long in space and holds nothing new
                SCOPED_TRACE(testing::Message() << d << " dimensions, " << kernel.name << ", delta " << s.delta
                                                << ", alpha " << s.alpha << ", shifting " << s.shifting);
                SphFluid f = stirred(d, kernel, everywhere, cells_for(kernel));
                set_viscosity(f, MonaghanGingold{}, 3.0);
                expect_rates_of_formulas(f, s);
            }
        });
}

// The linear law taken for Tait's in the records, or sides of mixed kinds; open ones have no images.
TEST(SphSweep, OtherStateAndMixedSides) {
    for (const int d : {2, 3})
        for (const std::array<bool, 3> sides : {nowhere, {true, false, false}, {false, true, true}}) {
            SCOPED_TRACE(testing::Message() << d << " dimensions, periodic " << sides[0] << sides[1] << sides[2]);
            SphFluid f = stirred(d, WendlandC4{}, sides, {6, 9, 7});
            f.equation_of_state = LinearState{};
            set_viscosity(f, Morris{}, 3.0);
            expect_rates_of_formulas(f, all_extras);
        }
}

// A force of a on b without its reaction; copies that count twice.
TEST(SphSweep, ForcesConserveMomentum) {
    for (const int d : {2, 3})
        for_each_law<PairViscousTerm>([&](auto law) {
            SCOPED_TRACE(testing::Message() << d << " dimensions, " << law.name);
            SphFluid f = stirred(d, QuinticSpline{}, everywhere, {10, 9, 11});
            f.body_force = d == 2 ? Vec3(1.0, -2.0, 0.0) : Vec3(1.0, -2.0, 3.0);
            set_viscosity(f, law, law.name == "none" ? 0.0 : 3.0);
            set_extras(f, all_extras);
            start(f);
            const auto n = static_cast<double>(f.particles);
            EXPECT_LT((sum_of(f, f.a) - n * f.body_force).norm(), 1e-13 * n * largest(f, f.a));
        });
}

// A central viscosity that is not central (Morris' is none): an eddy would be braked by nothing.
TEST(SphSweep, CentralForcesConserveAngularMomentum) {
    for (const int d : {2, 3})
        for_each_law<PairViscousTerm>([&](auto law) {
            SphFluid f = stirred(d, WendlandC2{}, nowhere, {8, 8, 8});
            set_viscosity(f, law, law.name == "none" ? 0.0 : 3.0);
            set_extras(f, {0.0, 0.2, false});
            start(f);
            Vec3 torque = Vec3::Zero();
            double scale = 0.0;
            for (std::size_t k = 0; k < f.slots(); ++k)
                if (f.id[k] >= 0) {
                    torque += entry(f, f.x, k).cross(entry(f, f.a, k));
                    scale += entry(f, f.x, k).norm() * entry(f, f.a, k).norm();
                }
            if (law.name != "morris")
                EXPECT_LT(torque.norm(), 1e-13 * scale) << law.name << ", " << d << " dimensions";
            else
                EXPECT_GT(torque.norm(), 1e-9 * scale); // or the test sees nothing
        });
}

// A term that does not vanish with differences of velocity, density and concentration: noise in a fluid at rest.
TEST(SphSweep, UniformLatticeInUniformMotionFeelsNothing) {
    for (const int d : {2, 3})
        for_each_law<PairViscousTerm>([&](auto law) {
            SCOPED_TRACE(testing::Message() << d << " dimensions, " << law.name);
            SphFluid f = empty_fluid(box_of_dimensions(d, Vec3::Constant(0.8), everywhere), WendlandC2{}, 1.5);
            put_lattice(f, {8, 8, 8}, 0.0, 1);
            for (std::size_t k = 0; k < f.slots(); ++k) {
                f.rho[k] = 1.03 * f.density; // and under pressure
                f.v[0][k] = 3.0, f.v[1][k] = -1.0;
                if (d == 3) f.v[2][k] = 0.3;
            }
            set_viscosity(f, law, law.name == "none" ? 0.0 : 3.0);
            set_extras(f, all_extras);
            start(f);
            const double one_pair = f.mass * pressure(f, f.rho[0]) / (f.rho[0] * f.rho[0]) * std::abs(slope(f, f.h));
            EXPECT_LT(largest(f, f.a), 1e-11 * one_pair);
            EXPECT_LT(largest(f, f.spread), 1e-11 * std::abs(slope(f, f.h)) * f.mass / f.density);
            for (const double rate : f.drho) ASSERT_NEAR(rate, 0.0, 1e-15 * f.density * f.sound_speed / f.h);
        });
}

// Velocities used in place of their differences: results would depend on the frame of reference.
TEST(SphSweep, RatesDoNotDependOnTheFrame) {
    for (const int d : {2, 3}) {
        SphFluid f = stirred(d, WendlandC2{}, everywhere, {8, 7, 9});
        set_viscosity(f, MonaghanGingold{}, 3.0);
        set_extras(f, all_extras);
        SphFluid moving = f;
        for (std::size_t k = 0; k < f.slots(); ++k)
            for (std::size_t c = 0; c < static_cast<std::size_t>(d); ++c)
                moving.v[c][k] += 7.0 - 5.0 * static_cast<double>(c);
        start(f), start(moving);
        const double a_scale = largest(f, f.a);
        for (std::size_t k = 0; k < f.slots(); ++k) {
            ASSERT_EQ(f.id[k], moving.id[k]);
            EXPECT_LT((entry(f, f.a, k) - entry(moving, moving.a, k)).norm(), 1e-12 * a_scale);
            EXPECT_NEAR(f.drho[k], moving.drho[k], 1e-11 * f.density * f.sound_speed / f.h);
        }
    }
}

// Sums put together in the order in which threads finish, or a cluster at a chunk's end left out.
TEST(SphSweep, SameBitsForAnyNumberOfThreads) {
    for (const int d : {2, 3}) {
        SphFluid f = stirred(d, QuinticSpline{}, everywhere, d == 2 ? std::array{40, 41, 1} : std::array{12, 13, 14});
        set_viscosity(f, MonaghanGingold{}, 3.0);
        set_extras(f, all_extras);
        SphFluid serial = f;
        {
            const Threads one(1);
            start(serial);
        }
        for (const int n : {2, 4}) {
            const Threads several(n);
            SphFluid parallel = f;
            start(parallel);
            EXPECT_EQ(parallel.id, serial.id);
            expect_same_bits(parallel, serial);
            for (std::size_t c = 0; c < static_cast<std::size_t>(d); ++c)
                EXPECT_TRUE(same_bits(parallel.dv_spread[c].data(), serial.dv_spread[c].data(), serial.slots()));
        }
    }
}

namespace {

/// Decay rate of a shear wave by Morris' operator in the limit of many neighbours, over nu:
/// lambda = -2 integral of F(r) (1 - cos k y) over the space; the mean of cos k y over angles is J0 (sinc in space).
template <class Law> double decay(double k, double h, int dimensions) {
    const auto mean_of_cosine = [&](double z) {
        return dimensions == 2 ? std::cyl_bessel_j(0.0, z) : z > 0.0 ? std::sin(z) / z : 1.0;
    };
    const double shell = dimensions == 2 ? 2.0 * pi : 4.0 * pi;
    const double over_q =
        integral([&](double q) { return Law::f(q) * (1.0 - mean_of_cosine(k * h * q)) * std::pow(q, dimensions - 1); },
                 0.0, Law::support, 240);
    return -2.0 * shell * Law::sigma(dimensions) / (h * h) * over_q;
}

} // namespace

// Viscosity off by a factor that no twin shows, as the twin's formula would be off too: a wave decays at its own rate.
TEST(SphSweep, MorrisDampsAShearWaveAtItsRate) {
    for (const int d : {2, 3})
        for_each_law<Kernel>([&](auto kernel) {
            SCOPED_TRACE(testing::Message() << d << " dimensions, " << kernel.name);
            const std::array<int, 3> n = d == 2 ? std::array{25, 40, 1} : std::array{19, 24, 19};
            SphFluid f =
                empty_fluid(box_of_dimensions(d, 0.1 * Vec3(n[0], n[1], n[2]), everywhere), kernel, d == 2 ? 4.0 : 3.0);
            put_lattice(f, n, 0.0, 1);
            const double k = 2.0 * pi / f.domain.size[1], speed = 0.7, mu = 5.0;
            for (std::size_t a = 0; a < f.slots(); ++a) f.v[0][a] = speed * std::sin(k * f.x[1][a]);
            set_viscosity(f, Morris{}, mu);
            start(f);
            const double rate = mu / f.density * decay<decltype(kernel)>(k, f.h, d);
            EXPECT_GT(rate, 0.6 * mu / f.density * k * k); // near nu k^2, which it tends to for small k h
            EXPECT_LT(rate, 1.1 * mu / f.density * k * k);
            double worst = 0.0;
            for (std::size_t a = 0; a < f.slots(); ++a)
                worst = std::max(worst, (entry(f, f.a, a) + rate * entry(f, f.v, a)).norm());
            EXPECT_LT(worst, 1e-3 * rate * speed);
        });
}
