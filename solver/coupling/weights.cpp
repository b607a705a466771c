#include "coupling/weights.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numbers>

namespace plumb {

namespace {

constexpr std::size_t groups_per_task = 16;
const double least_porosity = 1.0 - std::numbers::pi / std::sqrt(18.0); // densest packing of equal spheres

template <class Body> void for_each_group(std::size_t groups, Body&& body) {
    parallel_chunks(
        groups,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g) body(g);
        },
        groups_per_task);
}

/// Calls body with the type of the kernel.
template <class Body> void with_kernel(const Kernel& kernel, Body&& body) {
    std::visit([&](const auto& law) { body(law); }, kernel);
}

/// W(r, h)/(sigma/h^3) and its factor.
struct Width {
    Pack inverse_h;
    double factor;
};
template <class Law> Width width(double h) { return {broadcast<Pack>(1.0 / h), Law::sigma(3) / (h * h * h)}; }

using Places = std::array<Pack, 3>;

Pack distance(const Places& x, const FluidRecord& b) {
    const Pack dx = x[0] - b.x, dy = x[1] - b.y, dz = x[2] - b.z;
    return square_root(dx * dx + dy * dy + dz * dz);
}

Places places_of_grains(const Weights& w, std::size_t group) {
    Places x{};
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
        const FluidRecord& own =
            w.grains.records[static_cast<std::size_t>(w.grains.record_of[pack_width * group + lane])];
        const int l = static_cast<int>(lane);
        x[0][l] = own.x, x[1][l] = own.y, x[2][l] = own.z;
    }
    return x;
}

Places places_of_particles(const SphFluid& f, std::size_t cluster) {
    Places x{};
    for (std::size_t c = 0; c < 3; ++c) std::memcpy(&x[c], &f.x[c][pack_width * cluster], sizeof(Pack));
    return x;
}

/// Writes a sum of every lane that is a grain's.
template <class Put> void for_each_grain_of(const Weights& w, std::size_t group, Put&& put) {
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
        const std::int32_t id = w.id[pack_width * group + lane];
        if (id >= 0) put(static_cast<std::size_t>(id), static_cast<int>(lane));
    }
}

/// Sums over the particles near a group of grains.
struct GatherSums {
    Pack spread{}, gather{}, eps{};
    std::array<Pack, 3> u{}, a{}, stress{};
};

template <class Law> GatherSums gather_sums(const Weights& w, const SphFluid& f, std::size_t group) {
    const Places x = places_of_grains(w, group);
    const Width spread = width<Law>(w.h.spread), gather = width<Law>(w.h.gather);
    const bool same = w.h.spread == w.h.gather;
    GatherSums sums;
    for (const std::int32_t record : w.fluid_near.near(group)) {
        const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
        const auto slot = static_cast<std::size_t>(w.slot_of_record[static_cast<std::size_t>(record)]);
        const Pack r = distance(x, b), weight = Law::w(r * gather.inverse_h), volume = broadcast<Pack>(b.volume);
        const Pack share = weight * volume;
        sums.gather += share;
        sums.spread += same ? share : Law::w(r * spread.inverse_h) * volume;
        sums.eps += share * broadcast<Pack>(f.eps[slot]);
        const double mass = f.mass * f.share[slot]; // times the acceleration: the force on the particle
        for (std::size_t c = 0; c < 3; ++c) {
            sums.u[c] += share * broadcast<Pack>(f.v[c][slot]);
            sums.a[c] += share * broadcast<Pack>(f.a[c][slot]);
            sums.stress[c] +=
                weight * broadcast<Pack>(mass * (f.a[c][slot] - f.body_force[static_cast<Eigen::Index>(c)]));
        }
    }
    return sums;
}

/// Mass of the grains over that of the fluid, spread as their forces are, at every particle of the fluid.
template <class Law> void spread_load(const Weights& w, const SphFluid& f, Field<double>& load) {
    load.resize(f.slots());
    const Width spread = width<Law>(w.h.spread);
    for_each_group(f.clusters.count, [&](std::size_t cluster) {
        const Places x = places_of_particles(f, cluster);
        Pack sum{};
        for (const std::int32_t record : w.grains_near.near(cluster)) {
            const FluidRecord& j = w.grains.records[static_cast<std::size_t>(record)];
            sum += Law::w(distance(x, j) * spread.inverse_h) * broadcast<Pack>(j.volume);
        }
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const std::size_t slot = pack_width * cluster + lane;
            const double volume = f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[slot])].volume;
            load[slot] = sum[static_cast<int>(lane)] * volume / (f.mass * f.share[slot]);
        }
    });
}

template <class Law>
void gather_load(const Weights& w, const SphFluid& f, const Field<double>& load, GatheredFluid& at) {
    const Width gather = width<Law>(w.h.gather);
    for_each_group(w.grains.count, [&](std::size_t group) {
        const Places x = places_of_grains(w, group);
        Pack sum{}, total{};
        for (const std::int32_t record : w.fluid_near.near(group)) {
            const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
            const auto slot = static_cast<std::size_t>(w.slot_of_record[static_cast<std::size_t>(record)]);
            const Pack share = Law::w(distance(x, b) * gather.inverse_h) * broadcast<Pack>(b.volume);
            sum += share * broadcast<Pack>(load[slot]);
            total += share;
        }
        for_each_grain_of(w, group, [&](std::size_t id, int lane) {
            at.load[id] = total[lane] > 0.0 ? sum[lane] / total[lane] : 0.0;
        });
    });
}

/// Writes to the record of every grain what is to be spread, over S_j; nothing where there is no fluid.
template <class Value> void write_records(Weights& w, const Domain& domain, Value&& value) {
    parallel_for(w.id.size(), [&](std::size_t slot) {
        if (w.id[slot] < 0) return;
        const double inverse = w.sum[slot] > 0.0 ? 1.0 / w.sum[slot] : 0.0;
        value(w.grains.records[static_cast<std::size_t>(w.grains.record_of[slot])],
              static_cast<std::size_t>(w.id[slot]), inverse);
    });
    update_images(w.grains, domain);
}

} // namespace

bool outdated(const Weights& w, const Domain& domain, const GrainPlaces& grains) {
    if (w.x_listed.size() != grains.size()) return true;
    const double allowed_sq = 0.25 * w.grains.skin * w.grains.skin;
    for (std::size_t j = 0; j < grains.size(); ++j)
        if (!(domain.minimum_image(grains.x[j] - w.x_listed[j]).squaredNorm() <= allowed_sq)) return true;
    return false;
}

void renew_weights(Weights& w, const SphFluid& f, const GrainPlaces& grains) {
    const std::size_t n = grains.size();
    w.x_listed.resize(n);
    VectorField x, none;
    for (std::size_t c = 0; c < 3; ++c) x[c].resize(n);
    std::vector<std::int32_t> id(n);
    for (std::size_t j = 0; j < n; ++j) {
        w.x_listed[j] = f.domain.wrapped(grains.x[j]);
        for (std::size_t c = 0; c < 3; ++c) x[c][j] = w.x_listed[j][static_cast<Eigen::Index>(c)];
        id[j] = static_cast<std::int32_t>(j);
    }
    const double reach = support(w.kernel) * w.h.greatest();
    assert(std::max(f.clusters.reach, f.clusters.images) >= reach);
    w.grains.reach = reach;
    w.grains.skin = f.clusters.skin;
    const double box = f.domain.size.prod();
    const double spacing = std::max(f.spacing, std::cbrt(box / static_cast<double>(std::max<std::size_t>(n, 1))));
    const ClusterOrder order = arrange(w.grains, {x, id, none}, f.domain, std::min(spacing, reach));
    w.grains.count = order.from.size() / pack_width;
    w.id.resize(order.from.size());
    for (std::size_t k = 0; k < w.id.size(); ++k) w.id[k] = order.copy[k] != 0 ? -1 : order.from[k];
    w.sum.assign(w.id.size(), 0.0);
    list_records(w.fluid_near, f.clusters.grid, lane_places(w.grains, 3), 3, reach + w.grains.skin, f.clusters.passive);
    list_records(w.grains_near, w.grains.grid, lane_places(f.clusters, 3), 3, reach + w.grains.skin, {});
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
        w.grains.records[static_cast<std::size_t>(w.grains.record_of[slot])] = {x[0], x[1], x[2], grains.volume[j],
                                                                                0.0,  0.0,  0.0,  0.0};
    });
    update_images(w.grains, domain);
}

std::int64_t set_porosity(SphFluid& f, const Weights& w) {
    f.eps.resize(f.slots());
    std::atomic<std::int64_t> clamped{0};
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const Width own = width<Law>(w.h.porosity);
        for_each_group(f.clusters.count, [&](std::size_t cluster) {
            const Places x = places_of_particles(f, cluster);
            Pack sum{};
            for (const std::int32_t record : w.grains_near.near(cluster)) {
                const FluidRecord& j = w.grains.records[static_cast<std::size_t>(record)];
                sum += Law::w(distance(x, j) * own.inverse_h) * broadcast<Pack>(j.p_over_rho_sq);
            }
            for (std::size_t lane = 0; lane < pack_width; ++lane) {
                const std::size_t slot = pack_width * cluster + lane;
                const double eps = 1.0 - own.factor * sum[static_cast<int>(lane)];
                if (eps < least_porosity && f.id[slot] >= 0) ++clamped;
                f.eps[slot] = std::max(eps, least_porosity);
            }
        });
    });
    return clamped;
}

void gather(Weights& w, const SphFluid& f, const std::vector<double>& mass, bool with_load, GatheredFluid& at) {
    const std::size_t n = mass.size();
    at.u.resize(n), at.a.resize(n), at.stress.resize(n), at.eps.resize(n), at.load.assign(n, 0.0);
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        for_each_group(w.grains.count, [&](std::size_t group) {
            const GatherSums sums = gather_sums<Law>(w, f, group);
            std::memcpy(&w.sum[pack_width * group], &sums.spread, sizeof(Pack));
            for_each_grain_of(w, group, [&](std::size_t id, int lane) {
                const double total = sums.gather[lane], inverse = total > 0.0 ? 1.0 / total : 0.0;
                at.eps[id] = total > 0.0 ? inverse * sums.eps[lane] : 1.0;
                for (std::size_t c = 0; c < 3; ++c) {
                    at.u[id][static_cast<Eigen::Index>(c)] = inverse * sums.u[c][lane];
                    at.a[id][static_cast<Eigen::Index>(c)] = inverse * sums.a[c][lane];
                    at.stress[id][static_cast<Eigen::Index>(c)] = inverse * sums.stress[c][lane];
                }
            });
        });
        if (!with_load) return;
        write_records(w, f.domain,
                      [&](FluidRecord& record, std::size_t id, double inverse) { record.volume = inverse * mass[id]; });
        Field<double> load;
        spread_load<Law>(w, f, load);
        gather_load<Law>(w, f, load, at);
    });
}

void spread(SphFluid& f, Weights& w, const std::vector<Vec3>& force) {
    write_records(w, f.domain, [&](FluidRecord& record, std::size_t id, double inverse) {
        const Vec3 per_sum = inverse * force[id];
        record.u = per_sum[0], record.v = per_sum[1], record.w = per_sum[2];
    });
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const Width own = width<Law>(w.h.spread);
        for_each_group(f.clusters.count, [&](std::size_t cluster) {
            const Places x = places_of_particles(f, cluster);
            std::array<Pack, 3> sum{};
            for (const std::int32_t record : w.grains_near.near(cluster)) {
                const FluidRecord& j = w.grains.records[static_cast<std::size_t>(record)];
                const Pack weight = Law::w(distance(x, j) * own.inverse_h);
                sum[0] += weight * broadcast<Pack>(j.u);
                sum[1] += weight * broadcast<Pack>(j.v);
                sum[2] += weight * broadcast<Pack>(j.w);
            }
            for (std::size_t lane = 0; lane < pack_width; ++lane) {
                const std::size_t slot = pack_width * cluster + lane;
                const double volume = f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[slot])].volume;
                const double factor = volume / (f.mass * f.share[slot]);
                for (std::size_t c = 0; c < 3; ++c) f.a[c][slot] += factor * sum[c][static_cast<int>(lane)];
            }
        });
    });
}

} // namespace plumb
