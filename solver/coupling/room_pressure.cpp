#include "coupling/room_pressure.hpp"

#include "coupling/weight_loops.hpp"

#include <cmath>

namespace plumb {

namespace {

/// (p - kappa) V of a particle [J], from its record.
double pressure_volume(const SphFluid& f, const FluidRecord& b, std::size_t slot) {
    return (own_pressure(f, pressure_of(f, b), f.eps[slot]) - f.wetting_pressure) * b.volume;
}

/// sum_a p_a V_a W and sum_a p_a V_a grad W over the particles that `near` names, about eight places.
struct PressureSums {
    Pack value{};
    std::array<Pack, 3> gradient{};
};
template <class Law>
PressureSums pressure_sums(const Weights& w, const SphFluid& f, const std::array<Pack, 3>& x,
                           std::span<const std::int32_t> near) {
    const double h = w.h.porosity;
    const Pack over_h = broadcast<Pack>(1.0 / h), sigma = broadcast<Pack>(Law::sigma(3) / (h * h * h));
    const Pack slope = sigma * over_h * over_h;
    PressureSums sums;
    for (const std::int32_t record : near) {
        const auto r = static_cast<std::size_t>(record);
        const FluidRecord& b = f.clusters.records[r];
        const Apart from = apart(x[0], x[1], x[2], b);
        const Pack pv = broadcast<Pack>(pressure_volume(f, b, static_cast<std::size_t>(w.slot_of_record[r])));
        const Pack q = from.r * over_h;
        sums.value += sigma * Law::w(q) * pv;
        const Pack along = slope * Law::f(q) * pv;
        for (std::size_t c = 0; c < 3; ++c) sums.gradient[c] += along * from.dx[c];
    }
    return sums;
}

Vec3 lane_of(const std::array<Pack, 3>& packs, int lane) { return {packs[0][lane], packs[1][lane], packs[2][lane]}; }

} // namespace

void add_room_pressure(SphFluid& f, const Weights& w) {
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const double h = w.h.porosity;
        const Pack over_h = broadcast<Pack>(1.0 / h), slope = broadcast<Pack>(Law::sigma(3) / std::pow(h, 5));
        for_each_group(f.clusters.count, [&](std::size_t cluster) {
            std::array<Pack, 3> taken{}; // - grad eps
            for_grains_near(w, w.porosity_lists(), f, cluster,
                            [&](const Apart& from, const CouplingRecord& j, std::size_t /*record*/) {
                                const Pack along = slope * Law::f(from.r * over_h) * broadcast<Pack>(j.volume);
                                for (std::size_t c = 0; c < 3; ++c) taken[c] += along * from.dx[c];
                            });
            Pack pv;
            for (std::size_t lane = 0; lane < pack_width; ++lane) {
                const std::size_t slot = pack_width * cluster + lane;
                const auto record = static_cast<std::size_t>(f.clusters.record_of[slot]);
                pv[static_cast<int>(lane)] = pressure_volume(f, f.clusters.records[record], slot);
            }
            const Pack factor = -pv / (broadcast<Pack>(f.mass) * load(f.share, cluster));
            for (std::size_t c = 0; c < 3; ++c) add(f.a[c], cluster, factor * taken[c]);
        });
    });
}

void gather_room_pressure(const Weights& w, const SphFluid& f, const MirroredGrains& mirrored,
                          const std::vector<WallBody>& walls, const std::vector<Vec3>& x, std::vector<Vec3>& stress) {
    std::vector<Vec3> of_mirror(mirrored.size());
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        for_each_group(w.grains.count, [&](std::size_t group) {
            Pack lanes[8];
            load_cluster(w.grains, w.records, group, lanes);
            const PressureSums sums =
                pressure_sums<Law>(w, f, {lanes[0], lanes[1], lanes[2]}, w.fluid_near_porosity().near(group));
            for_each_grain_of(w, group, [&](std::size_t id, int lane) { stress[id] = -lane_of(sums.gradient, lane); });
        });
        for_each_group((mirrored.size() + pack_width - 1) / pack_width, [&](std::size_t group) {
            const std::size_t first = pack_width * group;
            std::array<Pack, 3> places{};
            for (std::size_t lane = 0; lane < pack_width; ++lane) {
                const std::size_t q = std::min(first + lane, mirrored.size() - 1);
                const CouplingRecord& at = w.records[static_cast<std::size_t>(w.grains.record_of_passive[q])];
                const int l = static_cast<int>(lane);
                places[0][l] = at.x, places[1][l] = at.y, places[2][l] = at.z;
            }
            const PressureSums sums = pressure_sums<Law>(w, f, places, w.fluid_near_mirrors.near(group));
            for (std::size_t lane = 0; lane < pack_width && first + lane < mirrored.size(); ++lane) {
                const int l = static_cast<int>(lane);
                const Mirror& mirror = mirrored.of[first + lane];
                const Reflection seen = reflection(mirrored, mirror, walls, x[static_cast<std::size_t>(mirror.grain)]);
                of_mirror[first + lane] = -(seen.share * seen.turn.transpose() * lane_of(sums.gradient, l) +
                                            sums.value[l] * seen.share_gradient);
            }
        });
    });
    for (std::size_t q = 0; q < mirrored.size(); ++q) // in their order: same bits for any number of threads
        stress[static_cast<std::size_t>(mirrored.of[q].grain)] += of_mirror[q];
}

} // namespace plumb
