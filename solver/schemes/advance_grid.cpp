#include "schemes/advance_grid.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "grid/saddle_solver.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

constexpr int most_iterations = 300; // a solve that takes more will not come to its end

/// The velocity at the end of the step as the last steps continue.
Velocity continued(const GridFluid& f) {
    Velocity u = f.u;
    if (!two_steps_known(f)) return u;
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        parallel_for(u[c].size(), [&](std::size_t k) { u[c][k] = 2.0 * f.u[c][k] - f.u_before[c][k]; });
    return u;
}

/// The numbers of the unknown faces of component c in a vector.
template <class Of> Eigen::VectorXd unknowns(const GridFluid& f, std::size_t c, Of&& of) {
    Eigen::VectorXd values(f.unknowns[c]);
    for (std::size_t k = 0; k < f.unknown[c].size(); ++k)
        if (f.unknown[c][k] >= 0) values[f.unknown[c][k]] = of(k);
    return values;
}

/// Component c of the source at the unknown faces [m/s2].
Eigen::VectorXd source_at(const GridFluid& f, std::size_t c, double time) {
    if (std::holds_alternative<NoGridSource>(f.source)) return Eigen::VectorXd::Zero(f.unknowns[c]);
    const Block faces = f.grid.faces(c);
    const FluidNumbers numbers{f.domain.size, f.density, 0.0, f.viscosity, f.body_force, LinearState{}};
    return unknowns(f, c, [&](std::size_t k) {
        const Vec3 x = f.grid.face_centre(c, faces.place(k));
        return std::visit([&](const auto& law) { return law(x, time, numbers); },
                          f.source)[static_cast<Eigen::Index>(c)];
    });
}

/// Right-hand side: what the last steps leave, forces, known velocities, what the porosity gains.
Eigen::VectorXd right_hand_side(const GridFluid& f, const SaddleSystem& s, double now, double dt, double time) {
    const SaddleLayout at = layout(s);
    Eigen::VectorXd right(at.size);
    const bool two = two_steps_known(f);
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const MomentumRows& rows = s.momentum[c];
        const Eigen::VectorXd before = unknowns(f, c, [&](std::size_t k) {
            return two ? (2.0 * f.u[c][k] - 0.5 * f.u_before[c][k]) / dt : f.u[c][k] / dt;
        });
        const Eigen::VectorXd force =
            f.density * (source_at(f, c, time).array() + f.body_force[static_cast<Eigen::Index>(c)]);
        right.segment(at.begin[c], before.size()) =
            rows.mass.cwiseProduct(before) + rows.known + force.cwiseProduct(rows.room);
        if (!f.push[c].empty())
            right.segment(at.begin[c], before.size()) += unknowns(f, c, [&](std::size_t k) { return f.push[c][k]; });
    }
    right.tail(s.known_divergence.size()) = -s.known_divergence - s.pressure_scale * porosity_gain(f, dt);
    if (!f.foreseen.drift.empty()) right.tail(s.known_divergence.size()) -= (now * s.pressure_scale) * drift_out(f);
    return right;
}

} // namespace

bool two_steps_known(const GridFluid& f) { return f.second_order && !f.u_before[0].empty(); }

void advance_grid(GridFluid& f, double dt, std::int64_t step) {
    const double time = dt * static_cast<double>(step);
    if (f.medium && !is_steady(*f.medium)) change_porosity(f, medium_porosity(f, time));
    const Velocity carrier = continued(f);
    const double now = two_steps_known(f) ? 1.5 : 1.0; // what the difference in time has of the step's end
    const SaddleSystem s = saddle_system(f, carrier, now, dt);
    const SaddleLayout at = layout(s);
    const Eigen::VectorXd right = right_hand_side(f, s, now, dt, time);
    Eigen::VectorXd x(at.size);
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        x.segment(at.begin[c], f.unknowns[c]) = unknowns(f, c, [&](std::size_t k) { return carrier[c][k]; });
    for (std::size_t k = 0; k < f.p.size(); ++k)
        if (f.unknown_pressure[k] >= 0) x[at.begin[3] + f.unknown_pressure[k]] = f.p[k] / s.pressure_scale;
    ProjectionPreconditioner preconditioner(s);
    const SolveReport report = solve(s, preconditioner, right, f.residual, most_iterations, x);
    f.iterations += report.iterations;
    f.greatest_residual = std::max(f.greatest_residual, report.residual);
    if (!(report.residual <= 2.0 * f.residual))
        throw Diverged(step, time, "residual of the fluid's equations", -1, report.residual,
                       "the step's linear equations were not solved");
    const Velocity before = f.u;
    if (f.second_order) f.u_before = f.u;
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (std::size_t k = 0; k < f.u[c].size(); ++k)
            if (f.unknown[c][k] >= 0) f.u[c][k] = x[at.begin[c] + f.unknown[c][k]];
    for (std::size_t k = 0; k < f.p.size(); ++k)
        if (f.unknown_pressure[k] >= 0) f.p[k] = s.pressure_scale * x[at.begin[3] + f.unknown_pressure[k]];
    take_foreseen(f, before, dt);
}

} // namespace plumb
