#include "coupling/own_density.hpp"

#include "coupling/weight_loops.hpp"
#include "sph/corrected_terms.hpp"

#include <cmath>

namespace plumb {

namespace {

/// What a particle reads of another one.
struct alignas(64) OwnRecord {
    double x, y, z;    // [m]
    double volume;     // [m3]; 0 of a wall's or an open side's
    double rho_f;      // [kg/m3]
    double gx, gy, gz; // grad rho_f [kg/m4]
};

/// grad rho_f and grad eps of eight particles.
struct OwnGradients {
    Components<Pack, 3> rho_f, eps;
};

struct OwnFields {
    Field<OwnRecord> records;
    Field<double> eps; // by record
};

double own_density(const SphFluid& f, const FluidRecord& record, std::size_t slot) {
    return f.mass / record.volume * f.share[slot] / f.eps[slot];
}

OwnFields own_fields(const SphFluid& f, const Weights& w) {
    OwnFields own;
    const std::size_t n = f.clusters.records.size();
    own.records.resize(n);
    own.eps.resize(n);
    parallel_for(n, [&](std::size_t r) {
        const FluidRecord& record = f.clusters.records[r];
        const std::int32_t slot = w.slot_of_record[r];
        own.records[r] = {record.x, record.y, record.z, 0.0, 0.0, 0.0, 0.0, 0.0};
        if (slot < 0) return;
        own.records[r].volume = record.volume;
        own.records[r].rho_f = own_density(f, record, static_cast<std::size_t>(slot));
        own.eps[r] = f.eps[static_cast<std::size_t>(slot)];
    });
    return own;
}

/// Eight particles' own records, one per lane, field by field.
struct OwnLanes {
    Components<Pack, 3> x;
    Pack rho_f, eps;
    Components<Pack, 3> g;
};
OwnLanes lanes_of(const SphFluid& f, const OwnFields& own, std::size_t cluster) {
    Pack lanes[8];
    load_cluster(f.clusters, own.records, cluster, lanes);
    return {{lanes[0], lanes[1], lanes[2]}, lanes[4], load(f.eps, cluster), {lanes[5], lanes[6], lanes[7]}};
}

/// Calls body(b, its number, x_a - x_b, V_b f(q)) for the records near a cluster; grad W = sigma/h^5 f (x_a - x_b).
template <class Law, class Body>
[[gnu::always_inline]] inline void for_own_near(const SphFluid& f, const OwnFields& own, std::size_t cluster,
                                                const OwnLanes& a, Body&& body) {
    const Pack over_h = broadcast<Pack>(1.0 / f.h);
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        const OwnRecord& b = own.records[r];
        const Components<Pack, 3> dx{a.x.x - b.x, a.x.y - b.y, a.x.z - b.z};
        const Pack slope = Law::f(square_root(dot(dx, dx)) * over_h) * broadcast<Pack>(b.volume);
        body(b, r, dx, slope);
    }
}

/// Corrected gradients of a cluster: B sum V_b (q_b - q_a) grad W.
template <class Law>
OwnGradients own_gradients(const SphFluid& f, const OwnFields& own, std::size_t cluster, const OwnLanes& a) {
    const Pack zero = broadcast<Pack>(0.0), scale = broadcast<Pack>(Law::sigma(3) / std::pow(f.h, 5));
    OwnGradients sums{{zero, zero, zero}, {zero, zero, zero}};
    Symmetric<Pack, 3> moment{zero, zero, zero, zero, zero, zero};
    for_own_near<Law>(f, own, cluster, a,
                      [&](const OwnRecord& b, std::size_t r, const Components<Pack, 3>& dx, const Pack& slope) {
                          add_square<3>(moment, -slope, dx);
                          add(sums.rho_f, slope * (broadcast<Pack>(b.rho_f) - a.rho_f), dx);
                          add(sums.eps, slope * (broadcast<Pack>(own.eps[r]) - a.eps), dx);
                      });
    const Symmetric<Pack, 3> inverse = inverse_or_plain<3>(moment, scale);
    return {product<3>(inverse, sums.rho_f), product<3>(inverse, sums.eps)};
}

/// The gradients, of rho_f into the records; and what shifted particles change by.
template <class Law> void find_gradients(SphFluid& f, OwnFields& own) {
    for_each_group(f.clusters.count, [&](std::size_t cluster) {
        const OwnLanes a = lanes_of(f, own, cluster);
        const OwnGradients g = own_gradients<Law>(f, own, cluster, a);
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            OwnRecord& o = own.records[static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane])];
            const int l = static_cast<int>(lane);
            o.gx = g.rho_f.x[l], o.gy = g.rho_f.y[l], o.gz = g.rho_f.z[l];
        }
        if (f.shifting == 0.0) return;
        const Components<Pack, 3> s{load(f.spread[0], cluster), load(f.spread[1], cluster), load(f.spread[2], cluster)};
        store(f.drho_spread, cluster, (dot(s, g.rho_f) * a.eps + a.rho_f * dot(s, g.eps)) / load(f.share, cluster));
    });
    update_images(f.clusters, own.records, f.domain);
}

template <class Law> void diffuse(SphFluid& f, const OwnFields& own) {
    const Pack factor = broadcast<Pack>(f.extras.diffusion * Law::sigma(3) / std::pow(f.h, 5)),
               half = broadcast<Pack>(0.5);
    for_each_group(f.clusters.count, [&](std::size_t cluster) {
        const OwnLanes a = lanes_of(f, own, cluster);
        Pack sum = broadcast<Pack>(0.0);
        for_own_near<Law>(f, own, cluster, a,
                          [&](const OwnRecord& b, std::size_t /*r*/, const Components<Pack, 3>& dx, const Pack& slope) {
                              const Components<Pack, 3> both{a.g.x + b.gx, a.g.y + b.gy, a.g.z + b.gz};
                              sum += slope * (broadcast<Pack>(b.rho_f) - a.rho_f + half * dot(both, dx));
                          });
        add(f.drho, cluster, -factor * sum * a.eps / load(f.share, cluster));
    });
}

} // namespace

void even_out_own_density(SphFluid& f, const Weights& w) {
    if (f.extras.diffusion == 0.0 && f.shifting == 0.0) return;
    OwnFields own = own_fields(f, w);
    with_kernel(f.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        find_gradients<Law>(f, own);
        if (f.extras.diffusion > 0.0) diffuse<Law>(f, own);
    });
}

} // namespace plumb
