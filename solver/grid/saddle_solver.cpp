#include "grid/saddle_solver.hpp"

#include "core/parallel.hpp"

#include <cmath>

namespace plumb {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// How well the preconditioner's own systems are solved: 0.03 and 0.3 took as long or longer in all of the cavity at
// cell Reynolds numbers of 0.4 and 4 and an array of cylinders at 2.
constexpr double reduction = 0.1;
constexpr int most_cycles = 20;

/// The same bits for any number of threads.
double dot(const VectorXd& a, const VectorXd& b) {
    return ordered_sum(static_cast<std::size_t>(a.size()), 0.0,
                       [&](std::size_t k) { return a[static_cast<Index>(k)] * b[static_cast<Index>(k)]; });
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
    y.segment(at.begin[3], p.size()) = outflow;
    return y;
}

} // namespace

SaddleSystem saddle_system(const GridFluid& f, const Velocity& carrier, double per_time) {
    SaddleSystem s;
    s.dimensions = f.dimensions();
    s.closed = true;
    double momentum = 0.0, mass = 0.0;
    for (std::size_t c = 0; c < s.dimensions; ++c) {
        s.momentum[c] = momentum_rows(f, c, carrier, per_time);
        s.divergence[c] = divergence_rows(f, c);
        momentum += s.momentum[c].matrix.diagonal().squaredNorm();
        mass += s.divergence[c].squaredNorm();
        for (const GridSide& side : f.sides[c]) s.closed &= side.kind != GridSide::Kind::outflow;
    }
    s.pressure_scale = std::sqrt(momentum / mass);
    for (std::size_t c = 0; c < s.dimensions; ++c) {
        s.divergence[c] *= s.pressure_scale;
        s.gradient[c] = s.divergence[c].transpose();
    }
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
            std::make_unique<Multigrid>(system.momentum[c].compact.rows() > 0 ? system.momentum[c].compact : a);
        const RowMatrix scaled = inverse_diagonal_[c].asDiagonal() * system.gradient[c];
        const RowMatrix part = system.divergence[c] * scaled;
        poisson = c == 0 ? part : RowMatrix(poisson + part);
    }
    if (system.closed && poisson.rows() > 0) poisson.coeffRef(0, 0) *= 2.0; // the level of p is arbitrary: pinned here
    poisson_ = std::make_unique<Multigrid>(poisson);
}

VectorXd ProjectionPreconditioner::schur_inverse(const VectorXd& r) {
    const VectorXd q = poisson_->solve(r, reduction, most_cycles);
    VectorXd middle = VectorXd::Zero(r.size());
    for (std::size_t c = 0; c < system_->dimensions; ++c) {
        const VectorXd w = inverse_diagonal_[c].cwiseProduct(system_->gradient[c] * q);
        const VectorXd aw = system_->momentum[c].matrix * w;
        middle += system_->divergence[c] * inverse_diagonal_[c].cwiseProduct(aw);
    }
    return poisson_->solve(middle, reduction, most_cycles);
}

VectorXd ProjectionPreconditioner::operator()(const VectorXd& residual) {
    VectorXd x(layout_.size);
    const VectorXd p = schur_inverse(residual.segment(layout_.begin[3], layout_.size - layout_.begin[3]));
    x.segment(layout_.begin[3], p.size()) = p;
    for (std::size_t c = 0; c < system_->dimensions; ++c) {
        const Index n = system_->momentum[c].matrix.rows();
        const VectorXd force = residual.segment(layout_.begin[c], n) + system_->gradient[c] * p;
        x.segment(layout_.begin[c], n) = velocity_[c]->solve(force, reduction, most_cycles);
    }
    return x;
}

SolveReport solve(const SaddleSystem& s, ProjectionPreconditioner& preconditioner, const VectorXd& right,
                  double tolerance, int most_iterations, VectorXd& x) {
    const SaddleLayout at = layout(s);
    const double scale = length(right);
    SolveReport report;
    VectorXd r = right - product(s, at, x);
    const double start = length(r);
    report.residual = scale > 0.0 ? start / scale : start;
    const int most = most_iterations;
    if (report.residual <= tolerance || start == 0.0) return report;
    // GMRES (Saad & Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856), preconditioned from the right, Givens rotations
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most + 1, most);
    VectorXd g = VectorXd::Zero(most + 1);
    std::vector<VectorXd> basis{r / start}, searched;
    std::vector<double> cosine, sine;
    g[0] = start;
    int k = 0;
    for (; k < most && std::abs(g[k]) > tolerance * scale; ++k) {
        searched.push_back(preconditioner(basis.back()));
        VectorXd w = product(s, at, searched.back());
        for (int pass = 0; pass < 2; ++pass) // twice: rounding
            for (int j = 0; j <= k; ++j) {
                const double part = dot(basis[static_cast<std::size_t>(j)], w);
                h(j, k) += part;
                w -= part * basis[static_cast<std::size_t>(j)];
            }
        h(k + 1, k) = length(w);
        for (int j = 0; j < k; ++j) {
            const auto q = static_cast<std::size_t>(j);
            const double up = cosine[q] * h(j, k) + sine[q] * h(j + 1, k);
            h(j + 1, k) = -sine[q] * h(j, k) + cosine[q] * h(j + 1, k);
            h(j, k) = up;
        }
        const double norm = std::hypot(h(k, k), h(k + 1, k));
        cosine.push_back(h(k, k) / norm);
        sine.push_back(h(k + 1, k) / norm);
        const double left = h(k + 1, k);
        h(k, k) = norm;
        h(k + 1, k) = 0.0;
        g[k + 1] = -sine.back() * g[k];
        g[k] *= cosine.back();
        if (left == 0.0) {
            ++k;
            break;
        }
        basis.push_back(w / left);
    }
    for (int j = k - 1; j >= 0; --j) { // g becomes the weights of the searched directions
        for (int i = j + 1; i < k; ++i) g[j] -= h(j, i) * g[i];
        g[j] /= h(j, j);
        x += g[j] * searched[static_cast<std::size_t>(j)];
    }
    report.iterations = k;
    report.residual = length(right - product(s, at, x)) / (scale > 0.0 ? scale : 1.0);
    return report;
}

} // namespace plumb
