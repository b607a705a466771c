#include "run/sphere_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace plumb {

namespace {

/// Area of the part u < x, v < y of a disc of radius r around the origin.
double corner_area(double r, double x, double y) {
    if (x <= -r || y <= -r) return 0.0;
    x = std::min(x, r);
    y = std::min(y, r);
    // half-disc area between u = 0 and u: integral of sqrt(r^2 - u^2)
    const auto half = [r](double u) {
        return 0.5 * (u * std::sqrt(std::max(0.0, r * r - u * u)) + r * r * std::asin(std::clamp(u / r, -1.0, 1.0)));
    };
    const double c = std::sqrt(std::max(0.0, r * r - y * y)); // where the line v = y meets the circle
    double area = 0.0;
    if (x > -c) {
        const double end = std::min(x, c);
        area += half(end) - half(-c) + y * (end + c);
    }
    if (y > 0.0) { // beside the line's ends the whole chord lies below it
        area += 2.0 * (half(std::min(x, -c)) - half(-r));
        if (x > c) area += 2.0 * (half(x) - half(c));
    }
    return area;
}

/// Part of a sphere of radius R around the origin below height h in [-R, R].
double cap(double radius, double h) {
    return std::numbers::pi * (radius * radius * h - h * h * h / 3.0 + 2.0 / 3.0 * radius * radius * radius);
}

struct GaussRule {
    static constexpr int points = 16;
    std::array<double, points> node{}, weight{}; // on [-1, 1]

    GaussRule() { // Newton's method on the Legendre polynomial, from the asymptotic places of its roots
        for (int k = 0; k < points; ++k) {
            double x = std::cos(std::numbers::pi * (k + 0.75) / (points + 0.5));
            double slope = 0.0;
            for (int iteration = 0; iteration < 20; ++iteration) {
                double p = 1.0, before = 0.0;
                for (int n = 0; n < points; ++n) {
                    const double next = ((2 * n + 1) * x * p - n * before) / (n + 1);
                    before = p;
                    p = next;
                }
                slope = points * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            node[static_cast<std::size_t>(k)] = x;
            weight[static_cast<std::size_t>(k)] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
    }
};

/// Heights in [z0, z1] between which the slice is a smooth function of z: where its circle touches a side or a corner.
std::vector<double> breakpoints(double radius, const Vec3& lower, const Vec3& upper) {
    std::vector<double> heights{lower[2], upper[2]};
    const auto add = [&](double distance_sq) {
        const double z_sq = radius * radius - distance_sq;
        if (z_sq < 0.0) return;
        for (const double z : {-std::sqrt(z_sq), std::sqrt(z_sq)})
            if (z > lower[2] && z < upper[2]) heights.push_back(z);
    };
    for (const double x : {lower[0], upper[0]}) {
        add(x * x);
        for (const double y : {lower[1], upper[1]}) add(x * x + y * y);
    }
    for (const double y : {lower[1], upper[1]}) add(y * y);
    std::sort(heights.begin(), heights.end());
    return heights;
}

double integral_of_slices(double radius, const Vec3& lower, const Vec3& upper) {
    static const GaussRule rule;
    const std::vector<double> heights = breakpoints(radius, lower, upper);
    double volume = 0.0;
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
        // z = R sin(angle) takes the square root out of the slices near the poles
        const double begin = std::asin(std::clamp(heights[k] / radius, -1.0, 1.0));
        const double half = 0.5 * (std::asin(std::clamp(heights[k + 1] / radius, -1.0, 1.0)) - begin);
        for (std::size_t p = 0; p < GaussRule::points; ++p) {
            const double angle = begin + half * (1.0 + rule.node[p]);
            const double slice = radius * std::cos(angle);
            volume +=
                half * rule.weight[p] * slice * disc_rectangle_overlap(slice, lower[0], upper[0], lower[1], upper[1]);
        }
    }
    return volume;
}

} // namespace

double disc_rectangle_overlap(double r, double x0, double x1, double y0, double y1) {
    return corner_area(r, x1, y1) - corner_area(r, x0, y1) - corner_area(r, x1, y0) + corner_area(r, x0, y0);
}

double sphere_box_overlap(double radius, const Vec3& lower, const Vec3& upper) {
    const Vec3 low = lower.cwiseMax(-radius), high = upper.cwiseMin(radius);
    if ((low.array() >= high.array()).any()) return 0.0;
    int cut_axes = 0, cut_axis = 0;
    for (int c = 0; c < 3; ++c)
        if (low[c] > -radius || high[c] < radius) ++cut_axes, cut_axis = c;
    if (cut_axes <= 1) return cap(radius, high[cut_axis]) - cap(radius, low[cut_axis]);
    return integral_of_slices(radius, low, high);
}

} // namespace plumb
