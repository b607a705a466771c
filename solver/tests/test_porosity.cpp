// The laws of the fluid fraction: their integral, their tables, the edge of a slab, a grain's own volume.
#include "weights_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double h = 0.1, diameter = 0.13;

std::vector<SpaceKernel> kernels() {
    return {{WendlandC2{}, h}, {WendlandC4{}, h}, {CubicSpline{}, h}, {QuinticSpline{}, h}};
}
const std::vector<PorosityLaw> laws{KernelPorosity{}, OverlapPorosity{}, DeconvolvedPorosity{}};

double direct(const PorosityLaw& law, const SpaceKernel& w, double r, double d = diameter) {
    return std::visit([&](const auto& one) { return one(w, r, d); }, law);
}

/// G as the sweeps see it.
struct Tabulated {
    RadialTables tables;
    double reach;
    Tabulated(const PorosityLaw& law, const SpaceKernel& w) : reach(plumb::reach(law, w, diameter)) {
        tables.append(reach, [&](double r) { return direct(law, w, r); });
    }
    double operator()(double r) const { return tables({}, broadcast<Pack>(r))[0]; }
};

/// Integral of g(r) over [a, b] by the midpoint rule.
template <class G> double integral(double a, double b, G&& g) {
    constexpr int n = 20000;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += g(a + (b - a) * (k + 0.5) / n);
    return sum * (b - a) / n;
}

double transform(const std::function<double(double)>& g, double reach, double k) {
    return integral(0.0, reach, [&](double r) { return 4.0 * std::numbers::pi * r * std::sin(k * r) / k * g(r); });
}

} // namespace

// Room that is taken from the fluid twice or not at all: a wrong factor, a reach that cuts something off.
TEST(Porosity, IntegralIsOne) {
    for (const SpaceKernel& w : kernels())
        for (const PorosityLaw& law : laws) {
            const Tabulated g(law, w);
            const double room = integral(0.0, g.reach, [&](double r) { return 4.0 * std::numbers::pi * r * r * g(r); });
            EXPECT_NEAR(room, 1.0, 1e-6) << law_name(law) << " of " << law_name(w.kernel);
            EXPECT_EQ(g(g.reach * 1.0001), 0.0);
            EXPECT_EQ(g(10.0 * g.reach), 0.0);
        }
}

// The bound that radial_table.hpp promises.
TEST(Porosity, TablesAreWithinTheirError) {
    for (const SpaceKernel& w : kernels())
        for (const PorosityLaw& law : laws) {
            const Tabulated g(law, w);
            const double most = direct(law, w, 0.0);
            Random random(3);
            for (int k = 0; k < 500; ++k) {
                const double r = g.reach * (k < 100 ? random.uniform(0.0, 0.01) : random.uniform(0.0, 1.0));
                ASSERT_NEAR(g(r), direct(law, w, r), 1e-6 * most)
                    << law_name(law) << " of " << law_name(w.kernel) << r / h;
            }
        }
}

// A wrong lens, radius for diameter: the mean of W over a grain's sphere by 200 shells of 400 rings. Error of the
// midpoint rule: (d/2)^2/(24 x 200^2) times a second derivative of at most 10 W(0)/h^2.
TEST(Porosity, OverlapIsTheMeanOverTheSphere) {
    for (const SpaceKernel& w : kernels())
        for (const double r : {0.0, 0.02, 0.07, 0.15, 0.22, 0.26}) {
            double sum = 0.0;
            constexpr int shells = 200, rings = 400;
            for (int k = 0; k < shells; ++k) {
                const double rho = 0.5 * diameter * (k + 0.5) / shells;
                double mean = 0.0;
                for (int i = 0; i < rings; ++i) {
                    const double cosine = -1.0 + 2.0 * (i + 0.5) / rings;
                    mean += w(std::sqrt(r * r + rho * rho - 2.0 * r * rho * cosine)) / rings;
                }
                sum += 4.0 * std::numbers::pi * rho * rho * mean * 0.5 * diameter / shells;
            }
            EXPECT_NEAR(direct(OverlapPorosity{}, w, r), sum / sphere_volume(diameter), 1e-4 * w(0.0));
        }
}

// The sphere's own variance along an axis is d^2/20, and variances add.
TEST(Porosity, OverlapWidensByTheSphere) {
    for (const SpaceKernel& w : kernels()) {
        const auto variance = [](double reach, auto&& g) {
            return integral(0.0, reach, [&](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r * r * g(r); });
        };
        EXPECT_NEAR(variance(w.reach() + 0.5 * diameter, Tabulated(OverlapPorosity{}, w)),
                    variance(w.reach(), w) + diameter * diameter / 20.0, 1e-5 * h * h);
    }
}

// Another iteration of the deconvolution, a wrong sign, a sphere of another size: the transforms that the laws state,
// by which a grain's own disturbance is known; that of 2 W - W*W is 1 - (1 - What)^2.
TEST(Porosity, TransformsAreThoseOfTheProfiles) {
    for (const SpaceKernel& w : kernels())
        for (const PorosityLaw& law : laws) {
            const Tabulated g(law, w);
            for (const double kh : {1e-3, 0.3, 1.0, 2.0, 4.0}) {
                const double plain = transform(w, w.reach(), kh / h), found = transform(g, g.reach, kh / h);
                EXPECT_NEAR(found, transform(law, plain, kh / h, diameter), 1e-6) << law_name(law);
                if (std::holds_alternative<DeconvolvedPorosity>(law)) {
                    EXPECT_NEAR(found, 1.0 - (1.0 - plain) * (1.0 - plain), 1e-6);
                }
            }
        }
}

// A table of another diameter than the grain's, a neighbour out of the kernel's reach but within G's.
TEST(Porosity, IsThatOfAllPairs) {
    for (const PorosityLaw& law : laws) {
        const Setting s = setting({true, false, true}, different, 60, {}, law);
        const SpaceKernel w{s.weights.kernel, different.porosity};
        int left = 40;
        for_each_particle(s.fluid, [&](std::size_t k, const Vec3& x, double /*volume*/) {
            if (--left < 0) return;
            double eps = 1.0;
            for (std::size_t j = 0; j < s.grains.size(); ++j) {
                const double r = s.fluid.domain.minimum_image(x - s.grains.x[j]).norm();
                const double d = std::cbrt(6.0 * s.grains.volume[j] / std::numbers::pi);
                if (r < reach(law, w, d)) eps -= s.grains.volume[j] * direct(law, w, r, d);
            }
            ASSERT_NEAR(s.fluid.eps[k], eps, 1e-8);
        });
    }
}

// The edges of a slab of layers, each smeared over its plane, which the kernel's sum over the lattice does to 1e-3: at
// h of 2.5 spacings What is 2e-5, times K h of 16, four waves and two for 2 W. In one dimension, by transforms, the
// deconvolved edge is 0.351 h from the sharp one in the mean and the plain one 0.417 h, a ratio of 0.84, and it
// overshoots by 3.75 % of the jump, by 4.13 % where the slab is ten layers 0.4 h apart.
TEST(Porosity, DeconvolvedEdgesAreSharper) {
    constexpr double a = 0.05, phi = 0.2, wide = 0.125, lower = 0.4, upper = 0.9;
    std::array<double, 2> distance{}, most{};
    for (const std::size_t kind : {0U, 1U}) {
        const PorosityLaw law = kind == 0 ? PorosityLaw{KernelPorosity{}} : PorosityLaw{DeconvolvedPorosity{}};
        GrainPlaces grains;
        for (int i = 0; i < 24; ++i)
            for (int j = 0; j < 22; ++j)
                for (double z = lower + 0.5 * a; z < upper; z += a) {
                    grains.x.emplace_back((i + 0.5) * a, (j + 0.5) * a, z);
                    grains.volume.push_back(phi * a * a * a);
                }
        Weights weights;
        weights.kernel = WendlandC2{};
        weights.h = {wide, wide, wide};
        weights.porosity = law;
        const std::vector<double> mass(grains.size(), 1.0);
        const Setting s = coupled(stirred({true, true, true}, 0.2), weights, grains, mass);
        const SpaceKernel w{WendlandC2{}, wide};
        const auto sheet = [&](double z) { // 2 pi int_|z| G r dr
            return integral(std::min(std::abs(z), reach(law, w, 0.0)), reach(law, w, 0.0), [&](double r) {
                return 2.0 * std::numbers::pi * r * s.weights.tables({}, broadcast<Pack>(r))[0];
            });
        };
        int left = kind == 0 ? 0 : 100;
        for_each_particle(s.fluid, [&](std::size_t k, const Vec3& x, double /*volume*/) {
            const double eps = s.fluid.eps[k], sharp = x.z() > lower && x.z() < upper ? 1.0 - phi : 1.0;
            distance[kind] += std::abs(eps - sharp);
            most[kind] = std::max(most[kind], eps - 1.0);
            if (--left < 0) return;
            double layered = 1.0;
            for (double z = lower + 0.5 * a; z < upper; z += a) layered -= phi * a * sheet(x.z() - z);
            ASSERT_NEAR(eps, layered, 1e-3 * phi);
        });
    }
    EXPECT_LT(distance[1], 0.9 * distance[0]);
    EXPECT_LT(most[0], 1e-12);
    EXPECT_GT(most[1], 0.02 * phi);
    EXPECT_LT(most[1], (0.0413 + 1e-3) * phi);
}

// A part left over of the grain's own volume, or another grain's taken out.
TEST(Porosity, OwnVolumeIsTakenOut) {
    for (const PorosityLaw& law : laws) {
        SCOPED_TRACE(law_name(law));
        const Setting alone = setting({true, true, true}, different, 1, {}, law, false);
        EXPECT_NEAR(alone.at.eps[0], 1.0, 1e-14);
        EXPECT_LT(setting({true, true, true}, different, 1, {}, law, true).at.eps[0], 1.0 - 1e-5);

        const Setting s = setting({true, true, true}, different, 60, {}, law, false);
        for (std::size_t j = 0; j < s.grains.size(); j += 7) {
            Setting others = s;
            others.grains.volume[j] = 0.0;
            place_grains(others.weights, others.fluid.domain, others.grains);
            others.weights.own_volume = true;
            set_porosity(others.fluid, others.weights);
            gather(others.weights, others.fluid, others.mass, false, others.at);
            ASSERT_NEAR(s.at.eps[j], others.at.eps[j], 1e-13);
        }
    }
}

// A fluid fraction above 1 that a drag law takes the power of 1 - eps of, or that is set to 1 and not counted.
TEST(Porosity, FractionsAboveOneAreCounted) {
    std::vector<double> eps{0.5, 1.0 + 1e-15, 1.01, 1.0};
    EXPECT_EQ(bound_porosity(eps), 1);
    EXPECT_EQ(eps, (std::vector<double>{0.5, 1.0, 1.0, 1.0}));
}
