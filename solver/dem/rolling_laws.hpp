// Resistance to rolling: a couple that opposes the relative rotation of two grains in contact (twist excluded).
#pragma once

#include "core/laws.hpp"
#include "core/simd.hpp"
#include "dem/contact_laws.hpp"

namespace plumb {

template <class T> struct Rolling {
    Space<T> normal;   // from j to i
    Space<T> rotation; // omega_i - omega_j without its part along the normal [rad/s]
    T normal_force;    // >= 0 [N]
    T radius;          // R_i R_j / (R_i + R_j) [m]
    T inverse_inertia; // 1/I_i + 1/I_j [1/(kg m2)]
    T time_step;       // [s]
    Space<T> turn;     // of the normal during the step [rad]
};

struct NoRolling {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"m = 0", "any", "-"};
    static constexpr int history = 0;
    template <class T> struct Parameters { T unused{}; };
    explicit NoRolling(Table& /*table*/) {}
    NoRolling() = default;
    Parameters<double> parameters;
};

/// Constant couple against the rotation (type A of Ai et al. 2011), near rest at most `stopping_share` of what stops
/// it.
struct ConstantTorque {
    static constexpr std::string_view name = "constant_torque";
    static constexpr LawInfo info{"m = -mu_r R* f_n w/|w|, at most 1/3 of the couple that stops w in one step", "any",
                                  "Ai, Chen, Rotter & Ooi 2011, Powder Technol. 206, 269, model A"};
    static constexpr int history = 0;
    template <class T> struct Parameters {
        T friction; // mu_r [-]
    };
    explicit ConstantTorque(Table& table) : parameters{table.number("friction", non_negative)} {}
    Parameters<double> parameters;

    template <class T>
    [[gnu::always_inline]] static Space<T> torque(const Rolling<T>& r, const Parameters<T>& p, Space<T>& /*stretch*/) {
        const T zero = broadcast<T>(0.0);
        const T speed = square_root(dot(r.rotation, r.rotation));
        const T stopping = broadcast<T>(stopping_share) * speed / (r.inverse_inertia * r.time_step);
        const T magnitude = smaller(p.friction * r.radius * r.normal_force, stopping);
        return select(speed > zero, zero - magnitude / speed, zero) * r.rotation;
    }
};

/// Rolling spring and dashpot with a yield couple (type C of Ai et al. 2011): holds a pile at rest without creep.
struct ElasticPlastic {
    static constexpr std::string_view name = "elastic_plastic";
    static constexpr LawInfo info{
        "m = -(k_r s + c_r w), |k_r s| <= mu_r R* f_n, c_r = 2 zeta sqrt(k_r / (1/I_i + 1/I_j))", "any",
        "Ai, Chen, Rotter & Ooi 2011, Powder Technol. 206, 269, model C"};
    static constexpr int history = 3;
    template <class T> struct Parameters {
        T friction;  // mu_r [-]
        T stiffness; // k_r [N m/rad]
        T damping;   // zeta [-]
    };
    explicit ElasticPlastic(Table& table)
        : parameters{table.number("friction", non_negative), table.number("stiffness", positive),
                     table.number("damping", non_negative)} {}
    Parameters<double> parameters;

    template <class T>
    [[gnu::always_inline]] static Space<T> torque(const Rolling<T>& r, const Parameters<T>& p, Space<T>& stretch) {
        const T zero = broadcast<T>(0.0), one = broadcast<T>(1.0), half_step = broadcast<T>(0.5) * r.time_step;
        Space<T> now = turned(stretch, r.normal, r.turn) + half_step * r.rotation;
        const T bend = p.stiffness * square_root(dot(now, now));
        const T limit = p.friction * r.radius * r.normal_force;
        const auto yields = bend > limit;
        now = select(yields, limit / select(bend > zero, bend, one), one) * now;
        stretch = now + half_step * r.rotation;
        // The dashpot is switched off at yield: otherwise the couple would exceed the limit.
        const T dashpot = broadcast<T>(2.0) * p.damping * square_root(p.stiffness / r.inverse_inertia);
        return (zero - p.stiffness) * now - select(yields, zero, dashpot) * r.rotation;
    }
};

using RollingLaw = std::variant<NoRolling, ConstantTorque, ElasticPlastic>;

} // namespace plumb
