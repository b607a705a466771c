// Sources of the fluid: the manufactured flow's derivatives, the equations it closes, and the time they are taken at.
#include "core/initial_fields.hpp"
#include "core/scene.hpp"
#include "schemes/advance_fluid.hpp"

#include "fluid_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

const FluidNumbers numbers{Vec3(0.7, 0.7, 0.0), 900.0, 13.0, 18.0, Vec3::Zero(), Tait{}};

ManufacturedFlow made(double divergence) {
    ManufacturedFlow flow;
    flow.speed = 1.3, flow.divergence = divergence;
    return flow;
}

/// Derivative by central differences of the fourth order; `along` is an axis or 2 for time.
template <class F> auto slope(F&& field, const Vec3& x, double t, int along) {
    constexpr double step = 2e-4;
    const auto at = [&](int m) {
        Vec3 place = x;
        if (along < 2) place[along] += m * step;
        return field(place, along == 2 ? t + m * step : t);
    };
    return decltype(field(x, t))((at(-2) - 8.0 * at(-1) + 8.0 * at(1) - at(2)) / (12.0 * step));
}

} // namespace

// A wrong sign or factor in one of the many derivatives.
TEST(SphSources, ManufacturedDerivativesAreThoseOfItsFields) {
    for (const double divergence : {0.0, 0.3}) {
        const ManufacturedFlow flow = made(divergence);
        const auto v = [&](const Vec3& x, double t) { return Vec3(flow.at(x, t, numbers).v); };
        const auto p = [&](const Vec3& x, double t) { return flow.at(x, t, numbers).p; };
        for (const Vec3& x : {Vec3(0.1, 0.23, 0.0), Vec3(0.52, 0.61, 0.0), Vec3(0.33, 0.04, 0.0)}) {
            const double t = 0.21;
            const ManufacturedFlow::State s = flow.at(x, t, numbers);
            const Vec3 by_x = slope(v, x, t, 0), by_y = slope(v, x, t, 1);
            EXPECT_LT((s.v_rate - slope(v, x, t, 2)).norm(), 1e-6);
            EXPECT_LT((s.convection - s.v[0] * by_x - s.v[1] * by_y).norm(), 1e-6);
            EXPECT_NEAR(s.div_v, by_x[0] + by_y[1], 1e-6);
            EXPECT_LT((s.p_gradient - Vec3(slope(p, x, t, 0), slope(p, x, t, 1), 0.0)).norm(), 1e-3);
            EXPECT_NEAR(s.p_rate, slope(p, x, t, 2), 1e-3);
            const auto along = [&](int axis) {
                return slope([&](const Vec3& y, double s2) { return slope(v, y, s2, axis); }, x, t, axis);
            };
            EXPECT_LT((s.laplacian - Vec3(along(0)) - Vec3(along(1))).norm(), 1e-4 * s.laplacian.norm());
            EXPECT_LE(std::abs(s.div_v), divergence > 0.0 ? 100.0 * divergence : 1e-12);
        }
    }
}

// Formulas of verification/mms, written out at one place, and the source terms from their definition.
TEST(SphSources, ManufacturedFlowByHand) {
    const double k = 2.0 * std::numbers::pi / 0.7, u = 1.3, t = 0.4, d = 0.3;
    const Vec3 x(0.13, 0.47, 0.0);
    const double a = k * x[0], b = k * x[1], c = std::cos(k * u * t), s = std::sin(k * u * t);
    const ManufacturedFlow::State state = made(d).at(x, t, numbers);
    const double swing = d * (0.5 + s) * std::sin(a - 2.0 * b);
    const Vec3 v(std::sin(a) * std::cos(b) - 0.5 * c * std::sin(2.0 * a + b) - swing,
                 -std::cos(a) * std::sin(b) + c * std::sin(2.0 * a + b) + 2.0 * swing, 0.0);
    EXPECT_LT((state.v - u * v).norm(), 1e-12);
    const double p = (std::cos(2.0 * a) + std::cos(b)) / 4.0 + s * std::sin(a + 2.0 * b) / 2.0;
    EXPECT_NEAR(state.p, 900.0 * u * u * p, 1e-9);
    ManufacturedSource source;
    source.flow = made(d);
    for (const EquationOfState& law : {EquationOfState(Tait{}), EquationOfState(LinearState{})}) {
        const auto rho = [&](const Vec3& y, double time) {
            return std::visit([&](const auto& l) { return l.density(made(d).at(y, time, numbers).p, 900.0, 13.0); },
                              law);
        };
        FluidNumbers of_law = numbers;
        of_law.equation_of_state = law;
        const SourceRates rates = source(x, t, of_law);
        const double carried =
            slope(rho, x, t, 2) + state.v[0] * slope(rho, x, t, 0) + state.v[1] * slope(rho, x, t, 1);
        EXPECT_NEAR(rates.density_rate, carried + rho(x, t) * state.div_v, 1e-5);
        const Vec3 acceleration =
            state.v_rate + state.convection + state.p_gradient / rho(x, t) - 18.0 / rho(x, t) * state.laplacian;
        EXPECT_LT((rates.acceleration - acceleration).norm(), 1e-10);
    }
    InitialField initial = [] {
        Scene scene =
            scene_from_text("initial = {law = \"manufactured\", speed = 1.3, divergence = 0.3}", "s.toml", "/");
        return make_family<InitialField>(scene.root.law("initial"));
    }();
    const FlowState first = std::visit([&](const auto& field) { return field(x, numbers); }, initial);
    EXPECT_EQ(first.u, made(d).at(x, 0.0, numbers).v);
    EXPECT_EQ(first.p, made(d).at(x, 0.0, numbers).p);
}

// Sources at one end of the step in place of its middle: the first order only. A lone particle feels nothing else.
TEST(SphSources, AreTakenInTheMiddleOfTheStep) {
    const auto end = [](int steps) {
        SphFluid f = empty_fluid(box_of_dimensions(2, Vec3(1.0, 1.0, 0.0), {}), WendlandC2{}, 1.5);
        ManufacturedSource source;
        source.flow.speed = 2.0;
        f.source = source;
        put(f, Vec3(0.3, 0.4, 0.0), Vec3(0.5, -0.2, 0.0), f.density);
        start(f);
        for (std::int64_t step = 1; step <= steps; ++step) advance_fluid(f, 0.1 / steps, step);
        return Eigen::Vector4d(f.x[0][0], f.x[1][0], f.v[0][0], f.v[1][0]);
    };
    const Eigen::Vector4d coarse = end(20), middle = end(40), fine = end(80);
    EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2.0, 0.15);
}
