#include "dem/cohesion_laws.hpp"

namespace plumb {

namespace {

constexpr Range angle_range{0.0, 0.5 * std::numbers::pi, false, true}; // a liquid that wets; else it would push

/// Liquid of a bridge: `volume` in m3, or {times_diameter_cubed = number} of the smaller grain.
struct BridgeVolume {
    double absolute = 0.0, per_cube = 0.0;
    explicit BridgeVolume(Table& table) {
        if (table.type("volume") != toml::node_type::table) {
            absolute = table.number("volume", positive);
            return;
        }
        Table given = table.table("volume");
        // V/R^3 is greatest for two equal grains, whose R is d/2
        per_cube = given.number("times_diameter_cubed", Range{0.0, LiquidBridge::largest_volume / 8.0, true, false});
    }
};

/// sqrt(4 c - b^2) of the denominator 1 + b x + c x^2.
double discriminant_root() {
    return std::sqrt(4.0 * LiquidBridge::square - LiquidBridge::linear * LiquidBridge::linear);
}

/// Integral of 1/(1 + b x + c x^2) from 0 to x.
double integrated(double x) {
    const double root = discriminant_root();
    const auto primitive = [&](double y) {
        return 2.0 / root * std::atan((2.0 * LiquidBridge::square * y + LiquidBridge::linear) / root);
    };
    return primitive(x) - primitive(0.0);
}

} // namespace

LiquidBridge::LiquidBridge(Table& table) : parameters{} {
    const double tension = table.number("surface_tension", positive);
    const double angle = table.number("contact_angle", angle_range);
    const BridgeVolume volume(table);
    const double reach = 1.0 + 0.5 * angle;
    parameters = {2.0 * std::numbers::pi * tension * std::cos(angle), reach * reach * reach, volume.absolute,
                  volume.per_cube};
}

double LiquidBridge::work_to_rupture(double s, double volume, double inverse_radius) const {
    const double radius = 2.0 / inverse_radius, scale = std::sqrt(radius / volume);
    return parameters.tension * radius / scale * (integrated(scale * rupture_distance(volume)) - integrated(scale * s));
}

double LiquidBridge::greatest_slope(double volume, double inverse_radius) const {
    const double radius = 2.0 / inverse_radius;
    // (b + 2 c x)/(1 + b x + c x^2)^2 is greatest where b + 2 c x = sqrt((4 c - b^2)/3)
    const double rise = discriminant_root() / std::numbers::sqrt3, x = (rise - linear) / (2.0 * square);
    const double denominator = 1.0 + x * (linear + square * x);
    return parameters.tension * radius * std::sqrt(radius / volume) * rise / (denominator * denominator);
}

} // namespace plumb
