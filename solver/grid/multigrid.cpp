#include "grid/multigrid.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

constexpr std::size_t share = 4096; // numbers that a thread takes at once
constexpr std::size_t few = 100;    // unknowns that are solved for directly
constexpr double relaxation = 0.8;  // of Jacobi's sweeps: damps the upper half of a five-point stencil's errors best
constexpr double coarse_reduction = 0.25; // of the residual on coarser levels, by
constexpr int coarse_cycles = 2;          // cycles at most (Notay & Vassilevski)
constexpr double stalled = 0.75;          // of the unknowns left by joining: no coarser level pays

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// Calls body(k) for all k of [begin, end), with threads where that pays.
template <class Body> void for_all(std::size_t n, Body&& body) {
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) body(k);
    };
    parallel_chunks(n, run, share);
}

/// In sixteen sums next to each other, by shares.
double dot(const Numbers& a, const Numbers& b) {
    std::vector<double> part((a.size() + share - 1) / share, 0.0);
    const auto run = [&](std::size_t begin, std::size_t end) {
        std::array<double, lanes> sum{};
        for (std::size_t k = begin; k < end; k += lanes)
            for (std::size_t q = 0; q < lanes; ++q)
                sum[q] += static_cast<double>(a[k + q]) * static_cast<double>(b[k + q]);
        for (const double s : sum) part[begin / share] += s;
    };
    parallel_chunks(a.size(), run, share);
    double total = 0.0;
    for (const double p : part) total += p;
    return total;
}

/// a += factor b.
void add(Numbers& a, double factor, const Numbers& b) {
    const auto f = static_cast<float>(factor);
    for_all(a.size(), [&](std::size_t k) { a[k] += f * b[k]; });
}

Eigen::MatrixXd full_matrix(const Equations& a) {
    const auto n = static_cast<Eigen::Index>(a.size());
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < a.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        full(row, row) = a.diagonal[k] > 0.0 ? a.diagonal[k] : 1.0;
        for (std::size_t e = at(a.begin[k]); e < at(a.begin[k + 1]); ++e) full(row, a.column[e]) = a.value[e];
    }
    return full;
}

} // namespace

Multigrid::Multigrid(const RowMatrix& matrix, int sweeps) : sweeps_(sweeps) {
    Equations fine = equations(matrix);
    if (std::any_of(fine.value.begin(), fine.value.end(), [](double v) { return v > 0.0; })) {
        given_ = slices(fine);
        fine = without_positive_couplings(std::move(fine));
    }
    while (fine.size() > few) {
        Aggregates fours = pairs(fine);
        const Equations half = joined(fine, fours);
        const Aggregates second = pairs(half);
        fours.count = second.count;
        for (int& of : fours.of)
            if (of >= 0) of = second.of[at(of)];
        if (fours.count == 0 || fours.count > stalled * static_cast<double>(fine.size())) break;
        add_level(fine);
        join(levels_.back(), fours);
        fine = joined(half, second);
    }
    add_level(fine);
    if (fine.size() <= few) coarsest_ = full_matrix(fine).partialPivLu().inverse();
}

void Multigrid::add_level(const Equations& a) {
    Level& l = levels_.emplace_back();
    l.rows = a.size();
    l.matrix = slices(a);
    for (Numbers* v : {&l.step, &l.right, &l.x, &l.left, &l.remains}) v->assign(padded_size(a.size()), 0.0F);
    for_all(a.size(), [&](std::size_t k) {
        if (a.diagonal[k] > 0.0) l.step[k + lanes] = static_cast<float>(relaxation / a.diagonal[k]);
    });
}

void Multigrid::join(Level& l, const Aggregates& g) {
    l.joint.assign(l.x.size(), 0);
    l.member_begin.assign(at(g.count) + 1, 0);
    for (std::size_t k = 0; k < l.rows; ++k) {
        if (g.of[k] < 0) continue;
        l.joint[k + lanes] = g.of[k] + static_cast<int>(lanes);
        ++l.member_begin[at(g.of[k]) + 1];
    }
    for (std::size_t k = 1; k < l.member_begin.size(); ++k) l.member_begin[k] += l.member_begin[k - 1];
    l.member.resize(at(l.member_begin.back()));
    std::vector<int> next(l.member_begin.begin(), l.member_begin.end() - 1);
    for (std::size_t k = 0; k < l.rows; ++k)
        if (g.of[k] >= 0) l.member[at(next[at(g.of[k])]++)] = static_cast<int>(k + lanes);
}

void Multigrid::sweep(Level& l, const Numbers& right, Numbers& x) {
    for_each_product(l.matrix, x, [&](std::size_t k, FloatPack ax) {
        put_pack(l.left, k, pack_at(x, k) + pack_at(l.step, k) * (pack_at(right, k) - ax));
    });
    l.left.swap(x);
}

void Multigrid::correct_from_next(std::size_t level, const Numbers& right, Numbers& x) {
    Level &l = levels_[level], &next = levels_[level + 1];
    for_each_product(l.matrix, x, [&](std::size_t k, FloatPack ax) { put_pack(l.left, k, pack_at(right, k) - ax); });
    for_all(next.rows, [&](std::size_t k) {
        float sum = 0.0F;
        for (int e = l.member_begin[k]; e < l.member_begin[k + 1]; ++e) sum += l.left[at(l.member[at(e)])];
        next.right[k + lanes] = sum;
    });
    krylov(level + 1, next.matrix, coarse_reduction, coarse_cycles);
    for_all(x.size(), [&](std::size_t k) { x[k] += next.x[at(l.joint[k])]; });
}

void Multigrid::cycle(std::size_t level, const Numbers& right, Numbers& x) {
    Level& l = levels_[level];
    for_all(x.size(), [&](std::size_t k) { x[k] = l.step[k] * right[k]; }); // the first sweep, from 0
    for (int k = 1; k < sweeps_; ++k) sweep(l, right, x);
    if (level + 1 < levels_.size()) correct_from_next(level, right, x);
    for (int k = 0; k < sweeps_; ++k) sweep(l, right, x);
}

/// The level's x from its right-hand side: generalised conjugate residuals (Eisenstat, Elman & Schultz 1983, SIAM J.
/// Numer. Anal. 20, 345).
void Multigrid::krylov(std::size_t level, const Slices& matrix, double reduction, int most_cycles) {
    Level& l = levels_[level];
    if (l.rows <= few) {
        solve_coarsest(l);
        return;
    }
    if (l.search.size() < at(most_cycles)) {
        l.search.resize(at(most_cycles));
        l.image.resize(at(most_cycles));
    }
    std::fill(l.x.begin(), l.x.end(), 0.0F);
    l.remains = l.right;
    std::vector<double> square;
    double left = dot(l.right, l.right);
    const double goal = reduction * reduction * left;
    for (std::size_t k = 0; k < at(most_cycles) && left > goal; ++k) {
        Numbers &search = l.search[k], &image = l.image[k];
        search.resize(l.x.size(), 0.0F);
        image.resize(l.x.size(), 0.0F);
        cycle(level, l.remains, search);
        for_each_product(matrix, search, [&](std::size_t p, FloatPack ax) { put_pack(image, p, ax); });
        for (std::size_t q = 0; q < k; ++q) {
            const double part = dot(image, l.image[q]) / square[q];
            add(image, -part, l.image[q]);
            add(search, -part, l.search[q]);
        }
        square.push_back(dot(image, image));
        if (!(square[k] > 0.0)) break;
        const double step = dot(image, l.remains) / square[k];
        add(l.x, step, search);
        add(l.remains, -step, image);
        left = dot(l.remains, l.remains);
    }
}

void Multigrid::solve_coarsest(Level& l) const {
    const auto n = static_cast<Eigen::Index>(l.rows);
    if (n == 0) return;
    const Eigen::VectorXd x = coarsest_ * Eigen::Map<const Eigen::VectorXf>(l.right.data() + lanes, n).cast<double>();
    for (std::size_t k = 0; k < l.rows; ++k) l.x[k + lanes] = static_cast<float>(x[static_cast<Eigen::Index>(k)]);
}

Eigen::VectorXd Multigrid::solve(const Eigen::VectorXd& right, double reduction, int most_cycles) {
    Level& l = levels_.front();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
    const double scale = right.size() > 0 ? right.cwiseAbs().maxCoeff() : 0.0; // may be smaller than a float can be
    if (!(scale > 0.0 && std::isfinite(scale))) return x;
    for_all(l.rows, [&](std::size_t k) {
        l.right[k + lanes] = static_cast<float>(right[static_cast<Eigen::Index>(k)] / scale);
    });
    krylov(0, given_ ? *given_ : l.matrix, reduction, most_cycles);
    for_all(l.rows,
            [&](std::size_t k) { x[static_cast<Eigen::Index>(k)] = scale * static_cast<double>(l.x[k + lanes]); });
    return x;
}

} // namespace plumb
