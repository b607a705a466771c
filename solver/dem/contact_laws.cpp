#include "dem/contact_laws.hpp"

#include <cmath>

namespace plumb {

namespace {

constexpr Range restitution_range{0.0, 1.0, true, false}; // e = 0 would need infinite damping
constexpr Range poisson_range{-1.0, 0.5, true, false};    // thermodynamic bounds

/// Half a period of the damped oscillator: pi / sqrt(k/m* - (c/2m*)^2) [s]. An overdamped contact has none; then the
/// undamped one is the shortest time in play.
template <class P> double linear_contact_time(const P& p, double inverse_mass) {
    const double rate = 0.5 * (p.damping + p.damping_root / std::sqrt(inverse_mass)) * inverse_mass;
    const double frequency_sq = p.stiffness * inverse_mass - rate * rate;
    return std::numbers::pi / std::sqrt(frequency_sq > 0.0 ? frequency_sq : p.stiffness * inverse_mass);
}

} // namespace

LinearNormal::LinearNormal(Table& table)
    : stiffness(table.number("stiffness", positive)), damping(0.0), damping_root(0.0) {
    if (table.has("restitution") == table.has("damping"))
        table.fail("restitution", "give either restitution or damping");
    if (table.has("damping"))
        damping = table.number("damping", non_negative);
    else
        damping_root = 2.0 * damping_ratio(table.number("restitution", restitution_range)) * std::sqrt(stiffness);
}

LinearSpring::LinearSpring(Table& table) : parameters{} {
    const LinearNormal normal(table);
    parameters.stiffness = normal.stiffness;
    parameters.damping = normal.damping;
    parameters.damping_root = normal.damping_root;
    parameters.friction = table.number("friction", non_negative);
    // Without friction the tangential spring never carries a force; its keys may be left out.
    const bool frictional = parameters.friction > 0.0;
    parameters.tangential_stiffness = frictional || table.has("tangential_stiffness")
                                          ? table.number("tangential_stiffness", positive)
                                          : parameters.stiffness;
    parameters.tangential_damping =
        frictional || table.has("tangential_damping") ? table.number("tangential_damping", non_negative) : 0.0;
}

double LinearSpring::contact_time(double inverse_mass, double /*inverse_radius*/, double /*speed*/) const {
    const double normal = linear_contact_time(parameters, inverse_mass);
    if (parameters.friction == 0.0) return normal;
    // Surface of two free spheres: a tangential impulse feels 2/7 of the mass.
    const double tangential = std::numbers::pi / std::sqrt(3.5 * parameters.tangential_stiffness * inverse_mass);
    return std::min(normal, tangential);
}

LinearSpringCoulomb::LinearSpringCoulomb(Table& table) : parameters{} {
    const LinearNormal normal(table);
    parameters = {normal.stiffness, normal.damping, normal.damping_root, table.number("friction", non_negative)};
}

double LinearSpringCoulomb::contact_time(double inverse_mass, double /*inverse_radius*/, double /*speed*/) const {
    return linear_contact_time(parameters, inverse_mass);
}

HertzMindlin::HertzMindlin(Table& table) : parameters{} {
    if (table.has("effective_modulus")) { // pairs of unlike materials
        parameters.modulus = table.number("effective_modulus", positive);
        parameters.shear_modulus = table.number("effective_shear_modulus", positive);
    } else { // two bodies of one material: 1/E* = 2 (1 - nu^2)/E, 1/G* = 2 (2 - nu)/G, G = E/(2 (1 + nu))
        const double young = table.number("young", positive);
        const double poisson = table.number("poisson", poisson_range);
        parameters.modulus = young / (2.0 * (1.0 - poisson * poisson));
        parameters.shear_modulus = young / (4.0 * (2.0 - poisson) * (1.0 + poisson));
    }
    // alpha = sqrt(5) |ln e| / sqrt(ln^2 e + pi^2) (Antypov & Elliott 2011, eq. 17)
    parameters.damping = std::sqrt(5.0) * damping_ratio(table.number("restitution", restitution_range));
    parameters.friction = table.number("friction", non_negative);
}

double HertzMindlin::contact_time(double inverse_mass, double inverse_radius, double speed) const {
    // Half oscillation of a Hertzian contact: 2.9432 (m*^2 / (k_h^2 v))^(1/5) with f = k_h o^1.5 and the factor
    // (5/4)^(2/5) of the largest overlap; Johnson 1985, Contact mechanics, sec. 11.4.
    const double k_h = 4.0 / 3.0 * parameters.modulus / std::sqrt(inverse_radius);
    const double reached = std::pow(1.25 * speed * speed / (inverse_mass * k_h), 0.4);
    // A contact stiffens with its overlap. Grains that start at rest still press on each other: allow for 1e-3 R*.
    const double overlap = std::max(reached, 1e-3 / inverse_radius);
    return 2.9432 / (std::pow(overlap, 0.25) * std::sqrt(0.8 * k_h * inverse_mass));
}

} // namespace plumb
