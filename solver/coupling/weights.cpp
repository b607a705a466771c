#include "coupling/weights.hpp"

#include "coupling/weight_loops.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace plumb {

namespace {

Pack inverse(double h) { return broadcast<Pack>(1.0 / h); }

/// Volumes of the eight particles of a cluster [m3].
Pack volumes(const SphFluid& f, std::size_t cluster) {
    Pack volume;
    for (std::size_t lane = 0; lane < pack_width; ++lane)
        volume[static_cast<int>(lane)] =
            f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane])].volume;
    return volume;
}

/// Sums over the particles near a group of grains.
struct GatherSums {
    Pack spread{}, gather{}, eps{};
    std::array<Pack, 3> u{}, a{}, stress{};
};

template <class Law> GatherSums gather_sums(const Weights& w, const SphFluid& f, std::size_t group) {
    const Pack spread = inverse(w.h.spread), gather = inverse(w.h.gather);
    const bool same = w.h.spread == w.h.gather;
    GatherSums sums;
    for_particles_near(w, f, group, [&](const Apart& apart, const FluidRecord& b, std::size_t slot) {
        const Pack weight = Law::w(apart.r * gather), volume = broadcast<Pack>(b.volume), share = weight * volume;
        sums.gather += share;
        sums.spread += same ? share : Law::w(apart.r * spread) * volume;
        sums.eps += share * broadcast<Pack>(f.eps[slot]);
        const double mass = f.mass * f.share[slot]; // times the acceleration: the force on the particle
        for (std::size_t c = 0; c < 3; ++c) {
            sums.u[c] += share * broadcast<Pack>(f.v[c][slot]);
            sums.a[c] += share * broadcast<Pack>(f.a[c][slot]);
            sums.stress[c] +=
                weight * broadcast<Pack>(mass * (f.a[c][slot] - f.body_force[static_cast<Eigen::Index>(c)]));
        }
    });
    return sums;
}

/// Of the velocity gathered at x: grad u = sum V (v - u)(x) grad W/sum V W, exactly. It is that of a linear flow as far
/// as the kernel's sum over the particles is that of its integral.
template <class Law> void gather_gradient(const Weights& w, const SphFluid& f, GatheredFluid& at) {
    const double over_h = 1.0 / w.h.gather;
    for_each_group(w.grains.count, [&](std::size_t group) {
        std::array<Pack, 3> u{}, slope{};
        std::array<std::array<Pack, 3>, 3> product{};
        for_particles_near(w, f, group, [&](const Apart& apart, const FluidRecord& b, std::size_t /*slot*/) {
            const Pack q = apart.r * broadcast<Pack>(over_h), volume = broadcast<Pack>(b.volume);
            const Pack share = Law::w(q) * volume, along = Law::f(q) * volume;
            const std::array<Pack, 3> v{broadcast<Pack>(b.u), broadcast<Pack>(b.v), broadcast<Pack>(b.w)};
            for (std::size_t c = 0; c < 3; ++c) {
                const Pack part = along * apart.dx[c];
                slope[c] += part;
                u[c] += share * v[c];
                for (std::size_t i = 0; i < 3; ++i) product[i][c] += v[i] * part;
            }
        });
        const Pack total = load(w.gather_sum, group);
        for_each_grain_of(w, group, [&](std::size_t id, int lane) {
            const double over_total = total[lane] > 0.0 ? 1.0 / total[lane] : 0.0, scale = over_total * over_h * over_h;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    at.gradient[id](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
                        scale * (product[i][c][lane] - over_total * u[i][lane] * slope[c][lane]);
        });
    });
}

/// Mass of the grains over that of the fluid, spread as their forces are, at every particle of the fluid.
template <class Law> void spread_load(Weights& w, const SphFluid& f) {
    const Pack own = inverse(w.h.spread);
    w.load.resize(f.slots());
    for_each_group(f.clusters.count, [&](std::size_t cluster) {
        Pack sum{};
        for_grains_near(w, w.grains_near, f, cluster,
                        [&](const Apart& apart, const CouplingRecord& j, std::size_t /*record*/) {
                            sum += Law::w(apart.r * own) * broadcast<Pack>(j.mass);
                        });
        store(w.load, cluster, sum * volumes(f, cluster) / (broadcast<Pack>(f.mass) * load(f.share, cluster)));
    });
}

template <class Law> void gather_load(const Weights& w, const SphFluid& f, GatheredFluid& at) {
    const Pack own = inverse(w.h.gather);
    for_each_group(w.grains.count, [&](std::size_t group) {
        Pack sum{};
        for_particles_near(w, f, group, [&](const Apart& apart, const FluidRecord& b, std::size_t slot) {
            sum += Law::w(apart.r * own) * broadcast<Pack>(b.volume) * broadcast<Pack>(w.load[slot]);
        });
        const Pack total = load(w.gather_sum, group);
        for_each_grain_of(w, group, [&](std::size_t id, int lane) {
            at.load[id] = total[lane] > 0.0 ? sum[lane] / total[lane] : 0.0;
        });
    });
}

/// Writes to the record of every grain what is to be spread, over S_j; nothing where there is no fluid.
template <class Value> void write_records(Weights& w, const Domain& domain, Value&& value) {
    parallel_for(w.id.size(), [&](std::size_t slot) {
        if (w.id[slot] < 0) return;
        const double over_sum = w.sum[slot] > 0.0 ? 1.0 / w.sum[slot] : 0.0;
        value(w.records[static_cast<std::size_t>(w.grains.record_of[slot])], static_cast<std::size_t>(w.id[slot]),
              over_sum);
    });
    update_images(w.grains, w.records, domain);
}

/// Numbers of the tables by record.
void list_tables(Weights& w, const MirroredGrains& mirrored) {
    w.table_of.assign(w.tables.size() > 0 ? w.records.size() : 0, 0);
    if (w.table_of.empty()) return;
    for (std::size_t k = 0; k < w.id.size(); ++k)
        if (w.id[k] >= 0)
            w.table_of[static_cast<std::size_t>(w.grains.record_of[k])] =
                w.table_of_grain[static_cast<std::size_t>(w.id[k])];
    for (std::size_t q = 0; q < mirrored.size(); ++q)
        w.table_of[static_cast<std::size_t>(w.grains.record_of_passive[q])] =
            w.table_of_grain[static_cast<std::size_t>(mirrored.of[q].grain)];
    for (std::size_t r = 0; r < w.table_of.size(); ++r)
        w.table_of[r] = w.table_of[static_cast<std::size_t>(w.grains.image_of[r])];
}

/// Lists of the grains near the planes of open sides, where the ways of their buffers' particles meet them.
void list_open_sides(Weights& w, const SphFluid& f, double reach) {
    const BoundaryParticles& b = f.boundary;
    w.open_member.clear();
    for (std::size_t k = 0; k < b.size(); ++k)
        if (b.side[k] >= 0) w.open_member.push_back(static_cast<std::int32_t>(k));
    w.open_near.parts.clear();
    if (w.open_member.empty()) return;
    while (w.open_member.size() % pack_width != 0) w.open_member.push_back(w.open_member.back());
    std::array<std::vector<double>, 3> places;
    for (const std::int32_t member : w.open_member) {
        const auto k = static_cast<std::size_t>(member);
        const OpenSide& side = f.open_sides[static_cast<std::size_t>(b.side[k])];
        const Vec3 x(b.x_listed[0][k], b.x_listed[1][k], b.x_listed[2][k]),
            on_plane = x - side.distance(x) * side.normal;
        for (std::size_t c = 0; c < 3; ++c) places[c].push_back(on_plane[static_cast<Eigen::Index>(c)]);
    }
    list_records(w.open_near, w.grains.grid, places, 3, reach, {});
}

/// Lists of the fluid's particles near mirrored grains.
void list_mirrored_grains(Weights& w, const SphFluid& f, double reach) {
    w.fluid_near_mirrors.parts.clear();
    const std::vector<Vec3>& x = w.mirrored_listed;
    if (x.empty()) return;
    std::array<std::vector<double>, 3> places;
    for (std::size_t q = 0; q < x.size() || q % pack_width != 0; ++q)
        for (std::size_t c = 0; c < 3; ++c)
            places[c].push_back(x[std::min(q, x.size() - 1)][static_cast<Eigen::Index>(c)]);
    list_records(w.fluid_near_mirrors, f.clusters.grid, places, 3, reach, f.clusters.passive);
}

/// Share of the room around the grains, as the gathering kernel weighs it, that fluid fills: sum_a V_a W over what
/// walls and open sides leave, 1 - sum_b V_b W over their particles; at most 1. The sums of weights are there.
void find_wet_share(const Weights& w, const SphFluid& f, GatheredFluid& at) {
    at.wet.assign(at.u.size(), 0.0);
    const double h = w.h.gather;
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const Pack over_h = broadcast<Pack>(1.0 / h), sigma = broadcast<Pack>(Law::sigma(3) / (h * h * h));
        for_each_group(w.grains.count, [&](std::size_t group) {
            Pack lanes[8];
            load_cluster(w.grains, w.records, group, lanes);
            Pack behind = broadcast<Pack>(0.0);
            for (const std::int32_t record : w.all_near.near(group)) {
                const auto r = static_cast<std::size_t>(record);
                if (w.slot_of_record[r] >= 0) continue; // fluid
                const FluidRecord& b = f.clusters.records[r];
                const Apart from = apart(lanes[0], lanes[1], lanes[2], b);
                behind += sigma * Law::w(from.r * over_h) * broadcast<Pack>(b.volume);
            }
            const Pack fluid = sigma * load(w.gather_sum, group); // which are kept without the kernel's constant
            for_each_grain_of(w, group, [&](std::size_t id, int lane) {
                // a wall's particles may overlap at its corners; a grain in one still has an eighth of the room
                at.wet[id] = std::min(1.0, fluid[lane] / std::max(1.0 - behind[lane], 0.125));
            });
        });
    });
}

} // namespace

bool outdated(const Weights& w, const Domain& domain, const GrainPlaces& grains) {
    if (w.x_listed.size() != grains.size()) return true;
    const double allowed_sq = 0.25 * w.grains.skin * w.grains.skin;
    const auto left = [&](std::size_t j) { // not near enough, or nowhere
        return domain.minimum_image(grains.x[j] - w.x_listed[j]).squaredNorm() <= allowed_sq ? 0 : 1;
    };
    return ordered_sum(grains.size(), 0, left) > 0;
}

void renew_weights(Weights& w, const SphFluid& f, const GrainPlaces& grains) {
    const std::size_t n = grains.size();
    w.x_listed.resize(n);
    VectorField x, mirrored;
    for (std::size_t c = 0; c < 3; ++c) x[c].resize(n);
    std::vector<std::int32_t> id(n);
    for (std::size_t j = 0; j < n; ++j) {
        w.x_listed[j] = f.domain.wrapped(grains.x[j]);
        for (std::size_t c = 0; c < 3; ++c) x[c][j] = w.x_listed[j][static_cast<Eigen::Index>(c)];
        id[j] = static_cast<std::int32_t>(j);
    }
    const double furthest = reach(w), skin = f.clusters.skin;
    assert(std::max(f.clusters.reach, f.clusters.images) >= furthest);
    w.grains.reach = furthest;
    w.grains.skin = f.clusters.skin;
    const double box = f.domain.size.prod();
    const double spacing = std::max(f.spacing, std::cbrt(box / static_cast<double>(std::max<std::size_t>(n, 1))));
    w.mirrored_listed.clear();
    for (const Vec3& place : grains.mirrored.x) w.mirrored_listed.push_back(f.domain.wrapped(place));
    for (std::size_t c = 0; c < 3; ++c)
        for (const Vec3& place : w.mirrored_listed) mirrored[c].push_back(place[static_cast<Eigen::Index>(c)]);
    const ClusterOrder order = arrange(w.grains, {x, id, mirrored}, f.domain, std::min(spacing, furthest));
    renew_size(w.records, w.grains.grid.records());
    w.id.resize(order.from.size());
    for (std::size_t k = 0; k < w.id.size(); ++k) w.id[k] = order.copy[k] != 0 ? -1 : order.from[k];
    w.sum.assign(w.id.size(), 0.0);
    w.gather_sum.assign(w.id.size(), 0.0);
    if (w.table_of_grain.size() != n) tabulate_porosity(w, grains);
    list_tables(w, grains.mirrored);
    const double exchange = exchange_reach(w) + skin, porosity = porosity_reach(w) + skin;
    const std::array<std::vector<double>, 3> fluid_places = lane_places(f.clusters, 3);
    list_records(w.fluid_near, f.clusters.grid, lane_places(w.grains, 3), 3, exchange, f.clusters.passive);
    list_records(w.grains_near, w.grains.grid, fluid_places, 3, exchange, w.grains.passive);
    w.porosity_near.parts.clear();
    w.fluid_far.parts.clear();
    list_open_sides(w, f, porosity);
    if (f.shares_pressure && f.free_surface)
        list_records(w.all_near, f.clusters.grid, lane_places(w.grains, 3), 3, exchange, {});
    if (f.shares_pressure) {
        if (porosity > exchange)
            list_records(w.fluid_far, f.clusters.grid, lane_places(w.grains, 3), 3, porosity, f.clusters.passive);
        list_mirrored_grains(w, f, porosity);
    }
    if (porosity > exchange || grains.mirrored.size() > 0)
        list_records(w.porosity_near, w.grains.grid, fluid_places, 3, porosity, {});
    w.slot_of_record.assign(f.clusters.records.size(), -1);
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0)
            w.slot_of_record[static_cast<std::size_t>(f.clusters.record_of[k])] = static_cast<std::int32_t>(k);
    parallel_for(w.slot_of_record.size(), [&](std::size_t r) {
        const auto source = static_cast<std::size_t>(f.clusters.image_of[r]);
        if (source != r) w.slot_of_record[r] = w.slot_of_record[source];
    });
}

void place_grains(Weights& w, const Domain& domain, const GrainPlaces& grains) {
    parallel_for(w.id.size(), [&](std::size_t slot) {
        if (w.id[slot] < 0) return;
        const auto j = static_cast<std::size_t>(w.id[slot]);
        const Vec3 x = w.x_listed[j] + domain.minimum_image(grains.x[j] - w.x_listed[j]);
        w.records[static_cast<std::size_t>(w.grains.record_of[slot])] = {x[0], x[1], x[2], grains.volume[j],
                                                                         0.0,  0.0,  0.0,  0.0};
    });
    parallel_for(grains.mirrored.size(), [&](std::size_t q) {
        const Vec3 x = w.mirrored_listed[q] + domain.minimum_image(grains.mirrored.x[q] - w.mirrored_listed[q]);
        w.records[static_cast<std::size_t>(w.grains.record_of_passive[q])] = {
            x[0], x[1], x[2], grains.mirrored.volume[q], 0.0, 0.0, 0.0, 0.0};
    });
    update_images(w.grains, w.records, domain);
}

std::int64_t gather(Weights& w, const SphFluid& f, const std::vector<double>& mass, bool with_load, GatheredFluid& at) {
    const std::size_t n = mass.size();
    at.u.resize(n), at.a.resize(n), at.stress.resize(n), at.eps.resize(n), at.dry.resize(n), at.load.assign(n, 0.0);
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        for_each_group(w.grains.count, [&](std::size_t group) {
            const GatherSums sums = gather_sums<Law>(w, f, group);
            store(w.sum, group, sums.spread);
            store(w.gather_sum, group, sums.gather);
            for_each_grain_of(w, group, [&](std::size_t id, int lane) {
                const double total = sums.gather[lane], over_total = total > 0.0 ? 1.0 / total : 0.0;
                at.dry[id] = total > 0.0 ? 0 : 1;
                at.eps[id] = total > 0.0 ? over_total * sums.eps[lane] : 1.0;
                for (std::size_t c = 0; c < 3; ++c) {
                    at.u[id][static_cast<Eigen::Index>(c)] = over_total * sums.u[c][lane];
                    at.a[id][static_cast<Eigen::Index>(c)] = over_total * sums.a[c][lane];
                    at.stress[id][static_cast<Eigen::Index>(c)] = over_total * sums.stress[c][lane];
                }
            });
        });
        if (at.wants_gradient) {
            at.gradient.resize(n);
            gather_gradient<Law>(w, f, at);
        }
        if (f.shares_pressure && f.free_surface) find_wet_share(w, f, at);
        if (!with_load) return;
        write_records(w, f.domain, [&](CouplingRecord& record, std::size_t id, double over_sum) {
            record.mass = over_sum * mass[id] * (at.wet.empty() ? 1.0 : at.wet[id]);
        });
        spread_load<Law>(w, f);
        gather_load<Law>(w, f, at);
        for (std::size_t id = 0; id < at.wet.size(); ++id) at.load[id] /= std::max(at.wet[id], 1e-12);
    });
    if (!w.own_volume) take_out_own_volume(w, f, at.eps);
    return bound_porosity(at.eps);
}

void spread(SphFluid& f, Weights& w, const std::vector<Vec3>& force) {
    write_records(w, f.domain, [&](CouplingRecord& record, std::size_t id, double over_sum) {
        const Vec3 per_sum = over_sum * force[id];
        record.fx = per_sum[0], record.fy = per_sum[1], record.fz = per_sum[2];
    });
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const Pack own = inverse(w.h.spread);
        for_each_group(f.clusters.count, [&](std::size_t cluster) {
            std::array<Pack, 3> sum{};
            for_grains_near(w, w.grains_near, f, cluster,
                            [&](const Apart& apart, const CouplingRecord& j, std::size_t /*record*/) {
                                const Pack weight = Law::w(apart.r * own);
                                sum[0] += weight * broadcast<Pack>(j.fx);
                                sum[1] += weight * broadcast<Pack>(j.fy);
                                sum[2] += weight * broadcast<Pack>(j.fz);
                            });
            const Pack factor = volumes(f, cluster) / (broadcast<Pack>(f.mass) * load(f.share, cluster));
            for (std::size_t c = 0; c < 3; ++c) add(f.a[c], cluster, factor * sum[c]);
        });
    });
}

} // namespace plumb
