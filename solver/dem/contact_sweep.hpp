// The hot loop: forces of all candidate pairs, eight at a time.
//
// Each pair is computed once and writes a line of its own; the forces of a grain are summed afterwards, in a fixed
// order. Two passes over a buffer that stays in the first-level cache: geometry (records are loaded whole and
// transposed, which beats gathering single numbers), then the contact law.
#pragma once

#include "core/domain.hpp"
#include "core/parallel.hpp"
#include "dem/contact_model.hpp"
#include "dem/neighbours.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace plumb {

namespace sweep {

inline constexpr std::size_t blocks_at_once = 8; // of 1 KiB each: with the records they read, within the L1 cache

/// Geometry of eight pairs.
struct Block {
    Contact<Pack> contact;
    Pack lever;           // |x_i - x_j| / (R_i + R_j)
    Space<Pack> rolling;  // omega_i - omega_j [rad/s], with a rolling law only
    Pack inverse_inertia; // 1/I_i + 1/I_j [1/(kg m2)], with a rolling law only
};

inline Pack load(const GrainRecord& record) {
    Pack p;
    std::memcpy(&p, &record, sizeof p);
    return p;
}

inline HalfPack load(const SpinRecord& record) {
    HalfPack p;
    std::memcpy(&p, &record, sizeof p);
    return p;
}

/// Sums R_i omega_i + R_j omega_j of eight pairs by component.
inline Space<Pack> spin_sum(const SpinRecord* spins, const std::int32_t* i, const std::int32_t* j) {
    Pack c[4];
    for (int k = 0; k < 4; ++k) {
        const HalfPack low = load(spins[i[k]]) + load(spins[j[k]]);
        const HalfPack high = load(spins[i[k + 4]]) + load(spins[j[k + 4]]);
        c[k] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    const Pack even_a = __builtin_shufflevector(c[0], c[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack odd_a = __builtin_shufflevector(c[0], c[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Pack even_b = __builtin_shufflevector(c[2], c[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack odd_b = __builtin_shufflevector(c[2], c[3], 1, 9, 3, 11, 5, 13, 7, 15);
    return {__builtin_shufflevector(even_a, even_b, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(odd_a, odd_b, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(even_a, even_b, 2, 3, 10, 11, 6, 7, 14, 15)};
}

inline void wrap(Pack& d, double size) {
    for (int lane = 0; lane < pack_width; ++lane) d[lane] -= size * std::nearbyint(d[lane] / size);
}

template <bool radii, bool rolls>
[[gnu::always_inline]] inline void compute_geometry(const Neighbours& list, std::size_t block, const Domain& domain,
                                                    double dt, Block& out) {
    const std::int32_t* i = list.i.data() + 8 * block;
    const std::int32_t* j = list.j.data() + 8 * block;
    const Pack sign{-1, -1, -1, 1, -1, -1, -1, 1}; // differences of x and v, sums of radius and inverse mass
    Pack d[8];
    for (int k = 0; k < 8; ++k)
        d[k] = load(list.records[static_cast<std::size_t>(i[k])]) +
               sign * load(list.records[static_cast<std::size_t>(j[k])]);
    transpose(d);
    if (list.crosses[block])
        for (int c = 0; c < 3; ++c)
            if (domain.periodic[static_cast<std::size_t>(c)]) wrap(d[c], domain.size[c]);
    const Space<Pack> dx{d[0], d[1], d[2]};
    const Pack distance = square_root(dot(dx, dx));
    const Pack inverse = broadcast<Pack>(1.0) / distance;
    Contact<Pack>& contact = out.contact;
    contact.overlap = d[3] - distance;
    contact.normal = inverse * dx;
    out.lever = distance / d[3];
    const Space<Pack> spin = spin_sum(list.spins.data(), i, j);
    contact.velocity = Space<Pack>{d[4], d[5], d[6]} - out.lever * cross(spin, contact.normal);
    contact.inverse_mass = d[7];
    contact.time_step = broadcast<Pack>(dt);
    contact.turn = (contact.time_step * inverse) * Space<Pack>{d[4], d[5], d[6]};
    if constexpr (radii || rolls)
        for (int k = 0; k < 8; ++k) {
            const auto a = static_cast<std::size_t>(i[k]), b = static_cast<std::size_t>(j[k]);
            const double ra = list.records[a].radius, rb = list.records[b].radius;
            contact.inverse_radius[k] = 1.0 / ra + 1.0 / rb;
            if constexpr (rolls) { // 1/I = 5 / (2 m R^2)
                out.inverse_inertia[k] =
                    2.5 * (list.records[a].inverse_mass / (ra * ra) + list.records[b].inverse_mass / (rb * rb));
                out.rolling.x[k] = list.spins[a].x / ra - list.spins[b].x / rb;
                out.rolling.y[k] = list.spins[a].y / ra - list.spins[b].y / rb;
                out.rolling.z[k] = list.spins[a].z / ra - list.spins[b].z / rb;
            }
        }
}

/// Parameters of eight pairs: the same for all, or each lane's own.
template <class Law> class LaneParameters {
public:
    using Packed = typename Law::template Parameters<Pack>;
    using Single = typename Law::template Parameters<double>;
    static constexpr std::size_t numbers = sizeof(Single) / sizeof(double);

    explicit LaneParameters(const PairLaws<Law>& pairs) : pairs_(pairs) {
        std::array<double, numbers> one{};
        std::memcpy(one.data(), &pairs.laws.front().parameters, sizeof one);
        for (std::size_t q = 0; q < numbers; ++q) same_[q] = broadcast<Pack>(one[q]);
    }
    [[gnu::always_inline]] Packed of(const Neighbours& list, std::size_t block) const {
        std::array<Pack, numbers> lanes = same_;
        if (!pairs_.uniform)
            for (std::size_t k = 0; k < 8; ++k) {
                const std::size_t p = 8 * block + k;
                const Single& own = pairs_.of(material(list, list.i[p]), material(list, list.j[p])).parameters;
                std::array<double, numbers> one{};
                std::memcpy(one.data(), &own, sizeof one);
                for (std::size_t q = 0; q < numbers; ++q) lanes[q][k] = one[q];
            }
        Packed packed;
        std::memcpy(&packed, lanes.data(), sizeof packed);
        return packed;
    }

private:
    static std::int32_t material(const Neighbours& list, std::int32_t grain) {
        return static_cast<std::int32_t>(list.spins[static_cast<std::size_t>(grain)].material);
    }
    const PairLaws<Law>& pairs_;
    std::array<Pack, numbers> same_;
};

inline Space<Pack> load_stretch(const double* at) {
    Space<Pack> s;
    std::memcpy(&s, at, sizeof s);
    return s;
}
inline void store_stretch(double* at, PackMask touching, const Space<Pack>& stretch) {
    const Pack zero = broadcast<Pack>(0.0);
    const Space<Pack> kept = select<Pack>(touching, stretch, {zero, zero, zero});
    std::memcpy(at, &kept, sizeof kept);
}

inline Pack smaller_radius(const Neighbours& list, std::size_t block) {
    Pack smaller;
    for (std::size_t k = 0; k < 8; ++k)
        smaller[k] = std::min(list.records[static_cast<std::size_t>(list.i[8 * block + k])].radius,
                              list.records[static_cast<std::size_t>(list.j[8 * block + k])].radius);
    return smaller;
}

/// Attraction of the bridges of eight pairs [N], 0 where there is none: forms those of pairs that touch, breaks those
/// of pairs too far apart.
[[gnu::always_inline]] inline Pack bridge_attraction(Neighbours& list, std::size_t block,
                                                     const LaneParameters<LiquidBridge>& laws, const Block& b,
                                                     PackMask touching) {
    const Pack zero = broadcast<Pack>(0.0), one = broadcast<Pack>(1.0);
    Pack volume;
    std::memcpy(&volume, list.bridge.data() + 8 * block, sizeof volume);
    const PackMask forming = touching & (volume == zero);
    if (!any(forming) && !any(volume > zero)) return zero;
    const LiquidBridge::Parameters<Pack> p = laws.of(list, block);
    if (any(forming)) volume = select(forming, LiquidBridge::formed_volume(p, smaller_radius(list, block)), volume);
    const Pack s = larger(zero - b.contact.overlap, zero);
    volume = select(LiquidBridge::holds(p, s, volume), volume, zero);
    std::memcpy(list.bridge.data() + 8 * block, &volume, sizeof volume);
    const PackMask bridged = volume > zero;
    return select(bridged, LiquidBridge::attraction(p, s, select(bridged, volume, one), b.contact.inverse_radius),
                  zero);
}

template <class Law, class RollingLawType, class CohesionType>
[[gnu::always_inline]] inline void apply_laws(Neighbours& list, std::size_t block, const LaneParameters<Law>& laws,
                                              const LaneParameters<RollingLawType>& rolling,
                                              const LaneParameters<CohesionType>& cohesion, const Block& b) {
    constexpr bool rolls = !std::is_same_v<RollingLawType, NoRolling>;
    const Pack zero = broadcast<Pack>(0.0);
    const PackMask touching = b.contact.overlap > zero;
    double* memory = list.stretch.data() + block * 8 * static_cast<std::size_t>(list.history);
    Space<Pack> stretch{zero, zero, zero};
    if constexpr (Law::history > 0) stretch = load_stretch(memory);
    const ContactForce<Pack> f = Law::force(b.contact, laws.of(list, block), stretch);
    if constexpr (Law::history > 0) store_stretch(memory, touching, stretch);
    const Space<Pack> force = f.normal * b.contact.normal + f.tangential;
    const Space<Pack> torque = (zero - b.lever) * cross(b.contact.normal, f.tangential);
    Pack rows[8] = {force.x, force.y, force.z, torque.x, torque.y, torque.z, zero, zero};
    for (int c = 0; c < 6; ++c) rows[c] = select(touching, rows[c], zero);
    if constexpr (std::is_same_v<CohesionType, LiquidBridge>) { // along the normal: no torque
        const Pack pull = bridge_attraction(list, block, cohesion, b, touching);
        const PackMask bridged = pull > zero;
        const Space<Pack> normal = select<Pack>(bridged, b.contact.normal, {zero, zero, zero});
        rows[0] -= pull * normal.x, rows[1] -= pull * normal.y, rows[2] -= pull * normal.z;
    }
    transpose(rows);
    for (std::size_t k = 0; k < 8; ++k) list.force[8 * block + k] = rows[k];
    if constexpr (rolls) {
        const Pack normal_force = larger(f.normal, zero);
        const Space<Pack> twist = dot(b.rolling, b.contact.normal) * b.contact.normal;
        const Rolling<Pack> state{
            b.contact.normal,  b.rolling - twist,   normal_force,  broadcast<Pack>(1.0) / b.contact.inverse_radius,
            b.inverse_inertia, b.contact.time_step, b.contact.turn};
        double* bend_at = memory + 8 * Law::history;
        Space<Pack> bend{zero, zero, zero};
        if constexpr (RollingLawType::history > 0) bend = load_stretch(bend_at);
        const Space<Pack> couple = RollingLawType::torque(state, rolling.of(list, block), bend);
        if constexpr (RollingLawType::history > 0) store_stretch(bend_at, touching, bend);
        for (int k = 0; k < 8; ++k)
            list.couple[8 * block + static_cast<std::size_t>(k)] =
                touching[k] ? PairCouple{couple.x[k], couple.y[k], couple.z[k], 0.0} : PairCouple{};
    }
}

} // namespace sweep

/// Forces of all candidate pairs from list.records and list.spins; the springs advance by dt [s].
template <class Law, class RollingLawType, class CohesionType>
void sweep_pairs(Neighbours& list, const PairLaws<Law>& contact, const PairLaws<RollingLawType>& rolling,
                 const PairLaws<CohesionType>& cohesion, const Domain& domain, double dt) {
    constexpr bool radii = std::is_same_v<Law, HertzMindlin> || std::is_same_v<CohesionType, LiquidBridge>;
    constexpr bool rolls = !std::is_same_v<RollingLawType, NoRolling>;
    const sweep::LaneParameters<Law> laws(contact);
    const sweep::LaneParameters<RollingLawType> rolling_laws(rolling);
    const sweep::LaneParameters<CohesionType> cohesion_laws(cohesion);
    parallel_chunks(
        list.padded() / 8,
        [&](std::size_t begin, std::size_t end) {
            std::array<sweep::Block, sweep::blocks_at_once> buffer;
            for (std::size_t at = begin; at < end; at += sweep::blocks_at_once) {
                const std::size_t count = std::min(sweep::blocks_at_once, end - at);
                for (std::size_t k = 0; k < count; ++k)
                    sweep::compute_geometry<radii, rolls>(list, at + k, domain, dt, buffer[k]);
                for (std::size_t k = 0; k < count; ++k)
                    sweep::apply_laws(list, at + k, laws, rolling_laws, cohesion_laws, buffer[k]);
            }
        },
        8 * sweep::blocks_at_once);
}

/// The same for the laws of `model`, chosen once.
void evaluate_pairs(Neighbours& list, const ContactModel& model, const Domain& domain, double dt);

/// The same with liquid bridges.
void evaluate_wet_pairs(Neighbours& list, const ContactModel& model, const PairLaws<LiquidBridge>& bridges,
                        const Domain& domain, double dt);

} // namespace plumb
