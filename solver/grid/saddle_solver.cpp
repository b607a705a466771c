#include "grid/saddle_solver.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// How well the preconditioner's own systems are solved. The commutator solves for the pressure twice, with a matrix in
// between that makes errors of short waves large: a tenth there took three times as many iterations of an array of 256
// cylinders in steady flow.
constexpr double pressure_reduction = 0.01, velocity_reduction = 0.03;
constexpr int most_cycles = 20, sweeps = 2;

/// In eight sums next to each other, by chunks: the same bits for any number of threads.
double dot(const VectorXd& a, const VectorXd& b) {
    constexpr std::size_t chunk = 4096;
    const auto n = static_cast<std::size_t>(a.size());
    std::vector<double> part((n + chunk - 1) / chunk, 0.0);
    const auto run = [&](std::size_t begin, std::size_t end) {
        std::array<double, 8> sum{};
        const double *x = a.data(), *y = b.data();
        std::size_t k = begin;
        for (; k + sum.size() <= end; k += sum.size())
            for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += x[k + q] * y[k + q];
        for (; k < end; ++k) sum[0] += x[k] * y[k];
        for (const double q : sum) part[begin / chunk] += q;
    };
    parallel_chunks(n, run, chunk);
    double total = 0.0;
    for (const double q : part) total += q;
    return total;
}
double length(const VectorXd& a) { return std::sqrt(dot(a, a)); }

/// Rows of the left-hand side for a vector of all unknowns.
VectorXd product(const SaddleSystem& s, const SaddleLayout& at, const VectorXd& x) {
    VectorXd y(at.size);
    const auto p = x.segment(at.begin[3], at.size - at.begin[3]);
    VectorXd outflow = VectorXd::Zero(p.size());
    for (std::size_t c = 0; c < s.dimensions; ++c) {
        const VectorXd u = x.segment(at.begin[c], s.momentum[c].matrix.rows());
        y.segment(at.begin[c], u.size()) = s.momentum[c].matrix * u - s.gradient[c] * p;
        outflow += s.divergence[c] * u;
    }
    if (s.yield[0].rows() > 0) outflow += s.yield[0] * p;
    y.segment(at.begin[3], p.size()) = outflow;
    return y;
}

} // namespace

namespace {

/// Y times `scale`, weighed by the powers of what smooth velocities feel of the diagonal.
void set_yield(const GridFluid& f, double scale, SaddleSystem& s) {
    constexpr double least = 0.01; // of rows that advection has brought near zero or below
    Velocity share;
    for (std::size_t c = 0; c < s.dimensions; ++c) share[c].assign(f.u[c].size(), scale);
    for (std::size_t power = 0; power < s.yield.size(); ++power) {
        s.yield[power] = yield_rows(f, share);
        for (std::size_t c = 0; c < s.dimensions && power + 1 < s.yield.size(); ++c) {
            const RowMatrix& a = s.momentum[c].matrix;
            const VectorXd felt = (a * VectorXd::Ones(a.cols())).cwiseQuotient(a.diagonal());
            for (std::size_t k = 0; k < share[c].size(); ++k)
                if (f.unknown[c][k] >= 0) share[c][k] *= std::clamp(felt[f.unknown[c][k]], least, 1.0);
        }
    }
}

} // namespace

SaddleSystem saddle_system(const GridFluid& f, const Velocity& carrier, double now, double dt) {
    SaddleSystem s;
    s.dimensions = f.dimensions();
    s.closed = !has_outflow(f);
    Field<double> following = f.foreseen.follows;
    for (double& share : following) share *= now;
    double momentum = 0.0, mass = 0.0;
    for (std::size_t c = 0; c < s.dimensions; ++c) {
        s.momentum[c] = momentum_rows(f, c, carrier, now / dt);
        s.divergence[c] = divergence_rows(f, c, following, false);
        momentum += s.momentum[c].matrix.diagonal().squaredNorm();
        mass += s.divergence[c].squaredNorm();
    }
    s.pressure_scale = std::sqrt(momentum / mass);
    for (std::size_t c = 0; c < s.dimensions; ++c) {
        s.divergence[c] *= s.pressure_scale;
        if (following.empty())
            s.gradient[c] = s.divergence[c].transpose();
        else
            s.gradient[c] = divergence_rows(f, c, f.foreseen.hands_on, true).transpose(),
            s.gradient[c] *= s.pressure_scale;
    }
    if (!f.foreseen.yields.empty()) set_yield(f, now * s.pressure_scale * s.pressure_scale, s);
    s.known_divergence = s.pressure_scale * known_divergence(f);
    return s;
}

SaddleLayout layout(const SaddleSystem& s) {
    SaddleLayout at;
    for (std::size_t c = 0; c < 3; ++c) {
        at.begin[c] = at.size;
        if (c < s.dimensions) at.size += s.momentum[c].matrix.rows();
    }
    at.begin[3] = at.size;
    at.size += s.divergence[0].rows();
    return at;
}

ProjectionPreconditioner::ProjectionPreconditioner(const SaddleSystem& system)
    : system_(&system), layout_(layout(system)) {
    RowMatrix poisson;
    for (std::size_t c = 0; c < system.dimensions; ++c) {
        const RowMatrix& a = system.momentum[c].matrix;
        inverse_diagonal_[c] = a.diagonal().cwiseInverse();
        velocity_[c] =
            std::make_unique<Multigrid>(system.momentum[c].compact.rows() > 0 ? system.momentum[c].compact : a, sweeps);
        const RowMatrix scaled = inverse_diagonal_[c].asDiagonal() * system.gradient[c];
        const RowMatrix part = system.divergence[c] * scaled;
        poisson = c == 0 ? part : RowMatrix(poisson + part);
    }
    if (system.yield[1].rows() > 0) poisson += system.yield[1];
    if (system.closed && poisson.rows() > 0) poisson.coeffRef(0, 0) *= 2.0; // the level of p is arbitrary: pinned here
    poisson_ = std::make_unique<Multigrid>(poisson, sweeps);
}

VectorXd ProjectionPreconditioner::schur_inverse(const VectorXd& r) {
    const VectorXd q = poisson_->solve(r, pressure_reduction, most_cycles);
    VectorXd middle = VectorXd::Zero(r.size());
    if (system_->yield[2].rows() > 0) middle = system_->yield[2] * q;
    for (std::size_t c = 0; c < system_->dimensions; ++c) {
        const VectorXd w = inverse_diagonal_[c].cwiseProduct(system_->gradient[c] * q);
        const VectorXd aw = system_->momentum[c].matrix * w;
        middle += system_->divergence[c] * inverse_diagonal_[c].cwiseProduct(aw);
    }
    return poisson_->solve(middle, pressure_reduction, most_cycles);
}

VectorXd ProjectionPreconditioner::operator()(const VectorXd& residual) {
    VectorXd x(layout_.size);
    const VectorXd p = schur_inverse(residual.segment(layout_.begin[3], layout_.size - layout_.begin[3]));
    x.segment(layout_.begin[3], p.size()) = p;
    for (std::size_t c = 0; c < system_->dimensions; ++c) {
        const Index n = system_->momentum[c].matrix.rows();
        const VectorXd force = residual.segment(layout_.begin[c], n) + system_->gradient[c] * p;
        x.segment(layout_.begin[c], n) = velocity_[c]->solve(force, velocity_reduction, most_cycles);
    }
    return x;
}

namespace {

/// Takes [cosine, sine] to a column of the Hessenberg matrix.
void rotate(Eigen::MatrixXd& h, int row, int column, const std::array<double, 2>& turn) {
    const double up = turn[0] * h(row, column) + turn[1] * h(row + 1, column);
    h(row + 1, column) = -turn[1] * h(row, column) + turn[0] * h(row + 1, column);
    h(row, column) = up;
}

/// Takes from w its parts along the basis and returns what is left of its length.
double orthogonalise(const std::vector<VectorXd>& basis, VectorXd& w, Eigen::MatrixXd& h, int column) {
    int j = 0;
    for (const VectorXd& b : basis) {
        h(j, column) = dot(b, w);
        const double part = h(j++, column);
        parallel_for(static_cast<std::size_t>(w.size()),
                     [&](std::size_t k) { w[static_cast<Index>(k)] -= part * b[static_cast<Index>(k)]; });
    }
    return length(w);
}

/// Improves x until what is left, `r` at first, is about `goal` long: GMRES (Saad & Schultz 1986, SIAM J. Sci. Stat.
/// Comput. 7, 856), preconditioned from the right, by another preconditioner each time (Saad 1993, SIAM J. Sci. Comput.
/// 14, 461). Returns the iterations.
int improve(const SaddleSystem& s, ProjectionPreconditioner& preconditioner, const VectorXd& r, double goal, int most,
            VectorXd& x) {
    const SaddleLayout at = layout(s);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most + 1, most);
    VectorXd g = VectorXd::Zero(most + 1);
    g[0] = length(r);
    std::vector<VectorXd> basis{r / g[0]}, searched;
    std::vector<std::array<double, 2>> turns;
    int k = 0;
    for (bool ended = false; !ended && k < most && std::abs(g[k]) > goal; ++k) {
        searched.push_back(preconditioner(basis.back()));
        VectorXd w = product(s, at, searched.back());
        h(k + 1, k) = orthogonalise(basis, w, h, k);
        ended = h(k + 1, k) == 0.0;
        if (!ended) basis.push_back(w / h(k + 1, k));
        for (int j = 0; j < k; ++j) rotate(h, j, k, turns[static_cast<std::size_t>(j)]);
        const double norm = std::hypot(h(k, k), h(k + 1, k));
        turns.push_back({h(k, k) / norm, h(k + 1, k) / norm});
        rotate(h, k, k, turns.back());
        g[k + 1] = -turns.back()[1] * g[k];
        g[k] *= turns.back()[0];
    }
    for (int j = k - 1; j >= 0; --j) { // g becomes the weights of the searched directions
        for (int i = j + 1; i < k; ++i) g[j] -= h(j, i) * g[i];
        g[j] /= h(j, j);
        x += g[j] * searched[static_cast<std::size_t>(j)];
    }
    return k;
}

} // namespace

SolveReport solve(const SaddleSystem& s, ProjectionPreconditioner& preconditioner, const VectorXd& right,
                  double tolerance, int most_iterations, VectorXd& x) {
    const SaddleLayout at = layout(s);
    const double length_of_right = length(right), scale = length_of_right > 0.0 ? length_of_right : 1.0;
    SolveReport report;
    VectorXd r = right - product(s, at, x);
    double before = std::numeric_limits<double>::infinity(), left = length(r);
    // again where rounding has cost the basis its right angles, as long as that helps
    for (double enough = 1.0; left > enough * tolerance * scale && left < 0.5 * before; enough = 1.5) {
        report.iterations += improve(s, preconditioner, r, tolerance * scale, most_iterations - report.iterations, x);
        r = right - product(s, at, x);
        before = left;
        left = length(r);
    }
    report.residual = left / scale;
    return report;
}

} // namespace plumb
