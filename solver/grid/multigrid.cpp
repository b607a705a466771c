#include "grid/multigrid.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

constexpr std::size_t block = 4096;       // rows of a sweep, and of a loop's share
constexpr std::size_t few = 100;          // unknowns that are solved for directly
constexpr double coarse_reduction = 0.25; // of the residual on coarser levels, by
constexpr int coarse_cycles = 2;          // cycles at most (Notay & Vassilevski)
constexpr double stalled = 0.75;          // of the unknowns left by joining: no coarser level pays

using Numbers = std::vector<float>;

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// Calls body(k) for all k of [0, n), with threads where that pays.
template <class Body> void for_all(std::size_t n, Body&& body) {
    parallel_chunks(
        n,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) body(k);
        },
        block);
}

/// In eight sums next to each other, by blocks.
double dot(const Numbers& a, const Numbers& b) {
    std::vector<double> part((a.size() + block - 1) / block, 0.0);
    const auto sum = [&](std::size_t begin, std::size_t end) {
        std::array<double, 8> lane{};
        std::size_t k = begin;
        for (; k + lane.size() <= end; k += lane.size())
            for (std::size_t q = 0; q < lane.size(); ++q)
                lane[q] += static_cast<double>(a[k + q]) * static_cast<double>(b[k + q]);
        for (; k < end; ++k) lane[0] += static_cast<double>(a[k]) * static_cast<double>(b[k]);
        part[begin / block] = ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
    };
    parallel_chunks(a.size(), sum, block);
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

Multigrid::Multigrid(const RowMatrix& matrix) {
    Equations fine = equations(matrix);
    given_ = single(fine);
    fine = without_positive_couplings(std::move(fine));
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
    if (fine.size() <= few) coarsest_.compute(full_matrix(fine));
}

Multigrid::Rows Multigrid::single(const Equations& a) {
    return {{a.diagonal.begin(), a.diagonal.end()}, a.begin, a.column, {a.value.begin(), a.value.end()}};
}

void Multigrid::add_level(const Equations& a) {
    Level& l = levels_.emplace_back();
    const std::size_t n = a.size();
    l.rows = single(a);
    l.inverse_diagonal.resize(n);
    for (std::vector<int>* place : {&l.block_begin, &l.upper, &l.block_end}) place->resize(n);
    for (Numbers* v : {&l.right, &l.x, &l.left, &l.remains}) v->resize(n);
    for_all(n, [&](std::size_t k) {
        l.inverse_diagonal[k] = a.diagonal[k] > 0.0 ? static_cast<float>(1.0 / a.diagonal[k]) : 0.0F;
        const auto first = a.column.begin() + a.begin[k], last = a.column.begin() + a.begin[k + 1];
        const auto place = [&](std::size_t column) {
            return static_cast<int>(std::lower_bound(first, last, static_cast<int>(column)) - a.column.begin());
        };
        l.block_begin[k] = place(k / block * block);
        l.upper[k] = place(k);
        l.block_end[k] = place((k / block + 1) * block);
    });
}

void Multigrid::join(Level& l, const Aggregates& g) {
    l.joint = g.of;
    l.member_begin.assign(at(g.count) + 1, 0);
    for (const int of : g.of)
        if (of >= 0) ++l.member_begin[at(of) + 1];
    for (std::size_t k = 1; k < l.member_begin.size(); ++k) l.member_begin[k] += l.member_begin[k - 1];
    l.member.resize(at(l.member_begin.back()));
    std::vector<int> next(l.member_begin.begin(), l.member_begin.end() - 1);
    for (std::size_t k = 0; k < l.size(); ++k)
        if (g.of[k] >= 0) l.member[at(next[at(g.of[k])]++)] = static_cast<int>(k);
}

void Multigrid::multiply(const Rows& a, const Numbers& x, Numbers& y) {
    for_all(x.size(), [&](std::size_t k) {
        float sum = a.diagonal[k] * x[k];
        for (int e = a.begin[k]; e < a.begin[k + 1]; ++e) sum += a.value[at(e)] * x[at(a.column[at(e)])];
        y[k] = sum;
    });
}

/// From x = 0.
void Multigrid::sweep_forwards(const Level& l, const Numbers& right, Numbers& x) const {
    const auto rows = [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            float sum = right[k];
            for (int e = l.block_begin[k]; e < l.upper[k]; ++e)
                sum -= l.rows.value[at(e)] * x[at(l.rows.column[at(e)])];
            x[k] = sum * l.inverse_diagonal[k];
        }
    };
    parallel_chunks(l.size(), rows, block);
}

void Multigrid::sweep_backwards(Level& l, const Numbers& right, Numbers& x) const {
    multiply(l.rows, x, l.left);
    const auto rows = [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = end; k-- > begin;) {
            float sum = right[k] - l.left[k];
            for (int e = l.upper[k]; e < l.block_end[k]; ++e)
                sum -= l.rows.value[at(e)] * l.left[at(l.rows.column[at(e)])];
            l.left[k] = sum * l.inverse_diagonal[k]; // from here on the change of x
            x[k] += l.left[k];
        }
    };
    parallel_chunks(l.size(), rows, block);
}

void Multigrid::correct_from_next(std::size_t level, const Numbers& right, Numbers& x) {
    Level &l = levels_[level], &next = levels_[level + 1];
    multiply(l.rows, x, l.left);
    for_all(next.size(), [&](std::size_t k) {
        float sum = 0.0F;
        for (int e = l.member_begin[k]; e < l.member_begin[k + 1]; ++e)
            sum += right[at(l.member[at(e)])] - l.left[at(l.member[at(e)])];
        next.right[k] = sum;
    });
    krylov(level + 1, next.rows, coarse_reduction, coarse_cycles);
    for_all(l.size(), [&](std::size_t k) {
        if (l.joint[k] >= 0) x[k] += next.x[at(l.joint[k])];
    });
}

void Multigrid::cycle(std::size_t level, const Numbers& right, Numbers& x) {
    sweep_forwards(levels_[level], right, x);
    if (level + 1 < levels_.size()) correct_from_next(level, right, x);
    sweep_backwards(levels_[level], right, x);
}

/// The level's x from its right-hand side: generalised conjugate residuals (Eisenstat, Elman & Schultz 1983, SIAM J.
/// Numer. Anal. 20, 345).
void Multigrid::krylov(std::size_t level, const Rows& rows, double reduction, int most_cycles) {
    Level& l = levels_[level];
    if (l.size() <= few) {
        solve_coarsest(l.right, l.x);
        return;
    }
    l.search.resize(std::max(l.search.size(), at(most_cycles)));
    l.image.resize(l.search.size());
    std::fill(l.x.begin(), l.x.end(), 0.0F);
    l.remains = l.right;
    std::vector<double> square;
    double left = dot(l.right, l.right);
    const double goal = reduction * reduction * left;
    for (std::size_t k = 0; k < at(most_cycles) && left > goal; ++k) {
        Numbers &search = l.search[k], &image = l.image[k];
        search.resize(l.size());
        image.resize(l.size());
        cycle(level, l.remains, search);
        multiply(rows, search, image);
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

void Multigrid::solve_coarsest(const Numbers& right, Numbers& x) const {
    const auto n = static_cast<Eigen::Index>(right.size());
    if (n == 0) return;
    const Eigen::VectorXd solution = coarsest_.solve(Eigen::Map<const Eigen::VectorXf>(right.data(), n).cast<double>());
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<float>(solution[static_cast<Eigen::Index>(k)]);
}

Eigen::VectorXd Multigrid::solve(const Eigen::VectorXd& right, double reduction, int most_cycles) {
    Level& l = levels_.front();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
    const double scale = right.size() > 0 ? right.cwiseAbs().maxCoeff() : 0.0; // may be smaller than a float can be
    if (!(scale > 0.0 && std::isfinite(scale))) return x;
    for_all(l.size(),
            [&](std::size_t k) { l.right[k] = static_cast<float>(right[static_cast<Eigen::Index>(k)] / scale); });
    krylov(0, given_, reduction, most_cycles);
    for_all(l.size(), [&](std::size_t k) { x[static_cast<Eigen::Index>(k)] = scale * static_cast<double>(l.x[k]); });
    return x;
}

} // namespace plumb
