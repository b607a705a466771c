#include "coupling/porosity_laws.hpp"

#include "core/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumb {

namespace {

constexpr int points = 12; // exact up to degree 23; the steepest kernel asks for 19

struct GaussRule {
    std::array<double, points> x{}, weight{}; // on [-1, 1]
    /// Zeros of Legendre's polynomial by Newton's method, e.g. Press et al., Numerical Recipes, sec. 4.5.
    GaussRule() {
        for (int i = 0; i < points; ++i) {
            double z = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1.0;
            for (int pass = 0; pass < 20; ++pass) {
                double p = 1.0, before = 0.0;
                for (int k = 1; k <= points; ++k) {
                    const double next = ((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k;
                    before = p, p = next;
                }
                slope = points * (z * p - before) / (z * z - 1.0);
                z -= p / slope;
            }
            const auto k = static_cast<std::size_t>(i);
            x[k] = z;
            weight[k] = 2.0 / ((1.0 - z * z) * slope * slope);
        }
    }
};

/// Integral from a to b, piece by piece between the knots.
template <class F> double integral(double a, double b, std::vector<double> knots, F&& f) {
    static const GaussRule rule;
    knots.push_back(a), knots.push_back(b);
    for (double& knot : knots) knot = std::clamp(knot, a, b);
    std::sort(knots.begin(), knots.end());
    double sum = 0.0;
    for (std::size_t k = 1; k < knots.size(); ++k) {
        const double half = 0.5 * (knots[k] - knots[k - 1]), middle = 0.5 * (knots[k] + knots[k - 1]);
        if (half <= 0.0) continue;
        for (std::size_t i = 0; i < points; ++i) sum += half * rule.weight[i] * f(middle + half * rule.x[i]);
    }
    return sum;
}

/// Multiples of h within the kernel's reach: where its polynomials meet.
std::vector<double> knots_of(const SpaceKernel& w) {
    std::vector<double> knots;
    for (double knot = 0.0; knot <= w.reach() * (1.0 + 1e-12); knot += w.h) knots.push_back(knot);
    return knots;
}

/// Mean of W over a sphere of radius rho whose centre is r away from W's.
double mean_on_sphere(const SpaceKernel& w, const std::vector<double>& knots, double r, double rho) {
    const double nearest = std::abs(r - rho), furthest = std::min(r + rho, w.reach());
    if (nearest >= furthest) return nearest < w.reach() ? w(nearest) : 0.0; // one of them is a point
    return integral(nearest, furthest, knots, [&](double t) { return t * w(t); }) / (2.0 * r * rho);
}

} // namespace

double convolution(const SpaceKernel& w, const std::function<double(double)>& q, double limit, double r) {
    const std::vector<double> knots = knots_of(w);
    std::vector<double> pieces = knots; // of q, and where the sphere's nearest or furthest point meets a knot of W
    for (const double knot : knots) pieces.insert(pieces.end(), {r - knot, knot - r, r + knot});
    return integral(0.0, limit, pieces, [&](double rho) {
        return 4.0 * std::numbers::pi * rho * rho * q(rho) * mean_on_sphere(w, knots, r, rho);
    });
}

double OverlapPorosity::operator()(const SpaceKernel& w, double r, double diameter) const {
    const double inside = 1.0 / sphere_volume(diameter);
    return convolution(
        w, [&](double /*rho*/) { return inside; }, 0.5 * diameter, r);
}

double DeconvolvedPorosity::operator()(const SpaceKernel& w, double r, double /*diameter*/) const {
    return 2.0 * w(r) - convolution(w, w, w.reach(), r);
}

} // namespace plumb
