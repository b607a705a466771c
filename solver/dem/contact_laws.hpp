// Forces of two grains in contact. A law is a pure function of one contact; it is written once for a number type T that
// is a double (walls, tests) or a pack of eight contacts (the sweep over pairs).
//
// Signs: overlap > 0 in contact; the normal points from j to i; the force is the one on i, that on j is its opposite.
// The normal force is not cut off where it turns attractive at the end of a damped contact: the contact ends when the
// overlap does, so the restitution of a head-on impact is exactly the number in the scene.
#pragma once

#include "core/laws.hpp"
#include "core/simd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

template <class T> struct Contact {
    T overlap;         // [m]
    Space<T> normal;   // unit vector from j to i
    Space<T> velocity; // of the surface of i against that of j at the contact point [m/s]
    T inverse_mass;    // 1/m_i + 1/m_j [1/kg]
    T inverse_radius;  // 1/R_i + 1/R_j [1/m]
    T time_step;       // [s]
    Space<T> turn;     // of the normal during the step [rad]; a part along the normal does not matter
};

/// Force on i, split because Coulomb's and the rolling limit need the normal part.
template <class T> struct ContactForce {
    T normal;            // along the normal, > 0 repulsive [N]
    Space<T> tangential; // [N]
};

/// Damping ratio beta of a linear oscillator that loses 1 - e^2 of its energy in half a period:
/// e = exp(-pi beta / sqrt(1 - beta^2)), hence beta = -ln e / sqrt(pi^2 + ln^2 e).
inline double damping_ratio(double restitution) {
    const double log_e = std::log(restitution);
    return -log_e / std::sqrt(std::numbers::pi * std::numbers::pi + log_e * log_e);
}

/// A vector of the old contact plane, turned with the normal into the new one. With s . n = s_e sin(angle), dropping
/// the part along n leaves s_e cos(angle) of the component that turns; half of (s . n) turn restores it up to the
/// third order in the angle.
template <class T>
[[gnu::always_inline]] inline Space<T> turned(const Space<T>& stretch, const Space<T>& normal, const Space<T>& turn) {
    const Space<T> longer = stretch + (broadcast<T>(0.5) * dot(stretch, normal)) * turn;
    return longer - dot(longer, normal) * normal;
}

/// Stretch of a tangential spring at the end of the step. The stretch is kept at half steps (midpoint rule, second
/// order).
template <class T>
[[gnu::always_inline]] inline Space<T> turned_stretch(const Space<T>& stretch, const Space<T>& slip,
                                                      const Contact<T>& c) {
    return turned(stretch, c.normal, c.turn) + (broadcast<T>(0.5) * c.time_step) * slip;
}

/// Share of the impulse that would stop a slip or a rotation within one step which a force without memory may give.
/// The force sees the predicted velocity v + a dt: with a share s, velocity and acceleration of consecutive steps obey
/// r^2 - (1 - 3s/2) r - s/2 = 0, which is stable below s = 1; there the root is -1, a force that changes sign for ever.
/// Shares that act on the same grain add up: friction and rolling resistance of one contact to 1.85 s, n contacts to at
/// most n s. With 1/3 a contact with both has roots 0.59 and -0.52, and three contacts are at the bound.
inline constexpr double stopping_share = 1.0 / 3.0;

/// A tangential spring and dashpot limited by Coulomb's friction; `stretch` is advanced to the next half step. A
/// contact that slides keeps the stretch which carries exactly the limit.
template <class T>
[[gnu::always_inline]] inline Space<T> frictional_force(const Contact<T>& c, const Space<T>& slip, const Space<T>& now,
                                                        T spring, T dashpot, T limit, Space<T>& stretch) {
    const Space<T> trial = spring * now + dashpot * slip;
    const T trial_sq = dot(trial, trial);
    const auto slides = trial_sq > limit * limit;
    Space<T> force = trial;
    Space<T> kept = now;
    if (any(slides)) {
        const T scale = select(slides, limit / square_root(trial_sq), broadcast<T>(1.0));
        force = scale * trial;
        const T inverse_spring = broadcast<T>(1.0) / spring;
        kept = select<T>(slides, inverse_spring * (force - dashpot * slip), now);
    }
    stretch = kept + (broadcast<T>(0.5) * c.time_step) * slip;
    return broadcast<T>(-1.0) * force;
}

/// Contact switched off: grains pass through each other (independent grains in one scene).
struct NoContact {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"f = 0", "any", "-"};
    static constexpr int history = 0; // numbers remembered from step to step
    template <class T> struct Parameters { T friction{}; };
    explicit NoContact(Table& /*table*/) {}
    Parameters<double> parameters;
    double contact_time(double /*inverse_mass*/, double /*inverse_radius*/, double /*speed*/) const {
        return std::numeric_limits<double>::infinity();
    }
};

/// Keys of the linear normal spring, shared by the two linear laws.
struct LinearNormal {
    double stiffness;    // k [N/m]
    double damping;      // c [kg/s], when given as a number
    double damping_root; // c / sqrt(m*) [sqrt(kg)/s], when given as a restitution

    explicit LinearNormal(Table& table);
};

/// f_n = k overlap - c v_n with v_n the normal velocity of i against j (negative while approaching).
template <class T, class P>
[[gnu::always_inline]] inline T linear_normal_force(const Contact<T>& c, T normal_velocity, const P& p) {
    const T damping = p.damping + p.damping_root * square_root(broadcast<T>(1.0) / c.inverse_mass);
    return p.stiffness * c.overlap - damping * normal_velocity;
}

/// Linear spring and dashpot, tangential spring with history (Cundall & Strack 1979; Luding 2008, Granular Matter 10).
struct LinearSpring {
    static constexpr std::string_view name = "linear_spring";
    static constexpr LawInfo info{"f_n = k o - c v_n, f_t = -(k_t s + c_t v_t), |f_t| <= mu f_n", "overlap << radius",
                                  "Cundall & Strack 1979, Geotechnique 29, 47"};
    static constexpr int history = 3;
    template <class T> struct Parameters {
        T stiffness, damping, damping_root, tangential_stiffness, tangential_damping, friction;
    };
    explicit LinearSpring(Table& table);
    Parameters<double> parameters;
    double contact_time(double inverse_mass, double inverse_radius, double speed) const;

    template <class T>
    [[gnu::always_inline]] static ContactForce<T> force(const Contact<T>& c, const Parameters<T>& p,
                                                        Space<T>& stretch) {
        const T normal_velocity = dot(c.velocity, c.normal);
        const T fn = linear_normal_force(c, normal_velocity, p);
        const Space<T> slip = c.velocity - normal_velocity * c.normal;
        const Space<T> now = turned_stretch(stretch, slip, c);
        const T limit = p.friction * larger(fn, broadcast<T>(0.0));
        return {fn, frictional_force(c, slip, now, p.tangential_stiffness, p.tangential_damping, limit, stretch)};
    }
};

/// Linear spring and dashpot with sliding friction only, f_t = -mu f_n t (mud-cake paper, Table 1, after Luding 1998).
/// Near rest the force is limited to `stopping_share` of what stops the slip within the step. The mass felt by a
/// tangential impulse at the surface of two spheres is m*/(1 + 5/2) (rotation included). Without memory there is no
/// static friction: a contact that carries a tangential force f creeps at f dt/(stopping_share (2/7) m*).
struct LinearSpringCoulomb {
    static constexpr std::string_view name = "linear_spring_coulomb";
    static constexpr LawInfo info{"f_n = k o - c v_n, f_t = -min(mu f_n, (2/21) m* |v_t| / dt) t", "overlap << radius",
                                  "Luding 1998, in Physics of dry granular media"};
    static constexpr int history = 0;
    template <class T> struct Parameters { T stiffness, damping, damping_root, friction; };
    explicit LinearSpringCoulomb(Table& table);
    Parameters<double> parameters;
    double contact_time(double inverse_mass, double inverse_radius, double speed) const;

    template <class T>
    [[gnu::always_inline]] static ContactForce<T> force(const Contact<T>& c, const Parameters<T>& p,
                                                        Space<T>& /*stretch*/) {
        const T zero = broadcast<T>(0.0);
        const T normal_velocity = dot(c.velocity, c.normal);
        const T fn = linear_normal_force(c, normal_velocity, p);
        const Space<T> slip = c.velocity - normal_velocity * c.normal;
        const T speed = square_root(dot(slip, slip));
        const T stopping = broadcast<T>(stopping_share * 2.0 / 7.0) * speed / (c.inverse_mass * c.time_step);
        const T magnitude = smaller(p.friction * larger(fn, zero), stopping);
        const T scale = select(speed > zero, magnitude / speed, zero);
        return {fn, (zero - scale) * slip};
    }
};

/// Hertz's normal force with the damping that makes the restitution a constant (Tsuji et al. 1992; exact by Antypov &
/// Elliott 2011, EPL 94, 50004), and Mindlin's tangential stiffness without micro-slip. While the contact is being
/// loaded the tangential force grows by S_t ds; while it is unloaded the force shrinks with S_t, otherwise a cycle
/// could make energy (Thornton, Cummins & Cleary 2013, Powder Technol. 233, 30).
struct HertzMindlin {
    static constexpr std::string_view name = "hertz_mindlin";
    static constexpr LawInfo info{
        "f_n = 4/3 E* sqrt(R*) o^1.5 - alpha sqrt(m* k_h) o^0.25 v_n, f_t: S_t = 8 G* sqrt(R* o), |f_t| <= mu f_n",
        "overlap << radius", "Mindlin & Deresiewicz 1953; Tsuji et al. 1992, Powder Technol. 71, 239"};
    static constexpr int history = 3;
    template <class T> struct Parameters {
        T modulus;       // E* [Pa]
        T shear_modulus; // G* [Pa]
        T damping;       // alpha [-]
        T friction;
    };
    explicit HertzMindlin(Table& table);
    Parameters<double> parameters;
    double contact_time(double inverse_mass, double inverse_radius, double speed) const;

    template <class T>
    [[gnu::always_inline]] static ContactForce<T> force(const Contact<T>& c, const Parameters<T>& p,
                                                        Space<T>& stretch) {
        const T zero = broadcast<T>(0.0), one = broadcast<T>(1.0);
        const T overlap = larger(c.overlap, zero);
        const T patch = square_root(overlap / c.inverse_radius); // contact radius sqrt(R* o) [m]
        const T normal_velocity = dot(c.velocity, c.normal);
        // alpha sqrt(m k_h) o^(1/4) = alpha sqrt(m (4/3) E* patch)
        const T dashpot = p.damping * square_root(broadcast<T>(4.0 / 3.0) * p.modulus * patch / c.inverse_mass);
        const T fn = broadcast<T>(4.0 / 3.0) * p.modulus * patch * overlap - dashpot * normal_velocity;
        const Space<T> slip = c.velocity - normal_velocity * c.normal;
        // Loading: the old stretch carries its old force, hence shrinks by S_t(before)/S_t(now). The overlap before
        // the step, to second order: o - o' dt + o'' dt^2/2 with o' = -v_n and o'' = -f_n/m*.
        const T bend = broadcast<T>(0.5) * c.time_step * c.time_step * c.inverse_mass * fn;
        const T before = larger(overlap + normal_velocity * c.time_step - bend, zero);
        const T ratio = square_root(smaller(select(overlap > zero, before / overlap, one), one));
        const Space<T> now = turned_stretch(ratio * stretch, slip, c);
        const T spring = broadcast<T>(8.0) * p.shear_modulus * patch;
        const T tangential_dashpot = dashpot * square_root(spring / (broadcast<T>(2.0) * p.modulus * patch));
        const T safe_spring = select(spring > zero, spring, one);
        const T safe_dashpot = select(spring > zero, tangential_dashpot, zero);
        const T limit = p.friction * larger(fn, zero);
        return {fn, frictional_force(c, slip, now, safe_spring, safe_dashpot, limit, stretch)};
    }
};

using ContactLaw = std::variant<NoContact, LinearSpring, LinearSpringCoulomb, HertzMindlin>;

/// Shortest time of a contact [s]: half an oscillation at impact speed `speed` [m/s]. Only Hertz depends on the speed,
/// and reckons with overlaps of 1e-3 of the reduced radius at least.
inline double contact_time(const ContactLaw& law, double inverse_mass, double inverse_radius, double speed) {
    return std::visit([&](const auto& l) { return l.contact_time(inverse_mass, inverse_radius, speed); }, law);
}

} // namespace plumb
