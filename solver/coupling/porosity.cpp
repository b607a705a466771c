// The fluid fraction at the fluid's particles, and the part of it that is a grain's own at the grain.
#include "coupling/weight_loops.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

using Numbers = RadialTables::Numbers;

const double least_porosity = 1.0 - std::numbers::pi / std::sqrt(18.0); // densest packing of equal spheres

/// G of the law `kernel`, over `factor`.
template <class Law> struct EvaluatedProfile {
    Pack inverse_h;
    double factor;
    explicit EvaluatedProfile(double h) : inverse_h(broadcast<Pack>(1.0 / h)), factor(Law::sigma(3) / (h * h * h)) {}
    Pack operator()(const Numbers& /*tables*/, const Pack& r) const { return Law::w(r * inverse_h); }
};

/// G from the tables.
struct TabulatedProfile {
    const RadialTables& all;
    static constexpr double factor = 1.0;
    Pack operator()(const Numbers& tables, const Pack& r) const { return all(tables, r); }
};

/// Calls body with G as the scene's law gives it.
template <class Body> void with_profile(const Weights& w, Body&& body) {
    if (w.tables.size() > 0) return body(TabulatedProfile{w.tables});
    with_kernel(w.kernel, [&](const auto& law) { body(EvaluatedProfile<std::decay_t<decltype(law)>>(w.h.porosity)); });
}

Numbers same_table(const Weights& w, std::size_t record) {
    Numbers tables{};
    if (!w.table_of.empty()) tables.fill(w.table_of[record]);
    return tables;
}

/// Tables of the grains of a group, by lane.
Numbers tables_of_group(const Weights& w, std::size_t group) {
    Numbers tables{};
    if (w.table_of.empty()) return tables;
    for (std::size_t lane = 0; lane < pack_width; ++lane)
        tables[lane] = w.table_of[static_cast<std::size_t>(w.grains.record_of[pack_width * group + lane])];
    return tables;
}

} // namespace

double porosity_reach(const Weights& w) { return reach(w.porosity, {w.kernel, w.h.porosity}, w.largest_diameter); }

void tabulate_porosity(Weights& w, const GrainPlaces& grains) {
    if (std::holds_alternative<KernelPorosity>(w.porosity) || grains.size() == 0) return;
    const bool differ = by_diameter(w.porosity);
    std::vector<double> volumes = grains.volume; // of the tables, ascending
    std::sort(volumes.begin(), volumes.end());
    volumes.erase(std::unique(volumes.begin(), volumes.end()), volumes.end());
    if (!differ) volumes.erase(volumes.begin() + 1, volumes.end());
    w.tables = {};
    const SpaceKernel kernel{w.kernel, w.h.porosity};
    for (const double volume : volumes) {
        const double diameter = std::cbrt(6.0 * volume / std::numbers::pi);
        w.tables.append(reach(w.porosity, kernel, diameter), [&](double r) {
            return std::visit([&](const auto& law) { return law(kernel, r, diameter); }, w.porosity);
        });
    }
    w.table_of_grain.assign(grains.size(), 0);
    for (std::size_t j = 0; differ && j < grains.size(); ++j)
        w.table_of_grain[j] = static_cast<std::int32_t>(
            std::lower_bound(volumes.begin(), volumes.end(), grains.volume[j]) - volumes.begin());
}

namespace {

/// eps of the buffers of open sides, on the planes; behind an even outlet, a sieve, it is 1.
template <class Profile> void set_porosity_of_buffers(SphFluid& f, const Weights& w, const Profile& profile) {
    BoundaryParticles& b = f.boundary;
    for_each_group(w.open_member.size() / pack_width, [&](std::size_t group) {
        std::array<Pack, 3> x{};
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const auto k = static_cast<std::size_t>(w.open_member[pack_width * group + lane]);
            const OpenSide& side = f.open_sides[static_cast<std::size_t>(b.side[k])];
            const Vec3 place(b.x[0][k], b.x[1][k], b.x[2][k]), on_plane = place - side.distance(place) * side.normal;
            for (std::size_t c = 0; c < 3; ++c) x[c][static_cast<int>(lane)] = on_plane[static_cast<Eigen::Index>(c)];
        }
        Pack sum{};
        for (const std::int32_t record : w.open_near.near(group)) {
            const auto r = static_cast<std::size_t>(record);
            const CouplingRecord& j = w.records[r];
            sum += profile(same_table(w, r), apart(x[0], x[1], x[2], j).r) * broadcast<Pack>(j.volume);
        }
        for (std::size_t lane = 0; lane < pack_width; ++lane) { // copies in the last group write the same
            const auto k = static_cast<std::size_t>(w.open_member[pack_width * group + lane]);
            const double eps = 1.0 - profile.factor * sum[static_cast<int>(lane)];
            b.eps[k] = f.open_sides[static_cast<std::size_t>(b.side[k])].even ? 1.0 : std::max(eps, least_porosity);
        }
    });
}

} // namespace

std::int64_t set_porosity(SphFluid& f, const Weights& w) {
    f.eps.resize(f.slots());
    std::atomic<std::int64_t> clamped{0};
    with_profile(w, [&](const auto& profile) {
        set_porosity_of_buffers(f, w, profile);
        for_each_group(f.clusters.count, [&](std::size_t cluster) {
            Pack sum{};
            for_grains_near(w, w.porosity_lists(), f, cluster,
                            [&](const Apart& apart, const CouplingRecord& j, std::size_t record) {
                                sum += profile(same_table(w, record), apart.r) * broadcast<Pack>(j.volume);
                            });
            for (std::size_t lane = 0; lane < pack_width; ++lane) {
                const std::size_t slot = pack_width * cluster + lane;
                const double eps = 1.0 - profile.factor * sum[static_cast<int>(lane)];
                if (eps < least_porosity && f.id[slot] >= 0) ++clamped;
                f.eps[slot] = std::max(eps, least_porosity);
            }
        });
    });
    return clamped;
}

void take_out_own_volume(const Weights& w, const SphFluid& f, std::vector<double>& eps) {
    with_kernel(w.kernel, [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const Pack inverse_h = broadcast<Pack>(1.0 / w.h.gather);
        with_profile(w, [&](const auto& profile) {
            for_each_group(w.grains.count, [&](std::size_t group) {
                const Numbers tables = tables_of_group(w, group);
                Pack sum{}, volume{};
                for_particles_near(w, f, group, [&](const Apart& apart, const FluidRecord& b, std::size_t /*slot*/) {
                    sum += Law::w(apart.r * inverse_h) * broadcast<Pack>(b.volume) * profile(tables, apart.r);
                });
                Pack lanes[8];
                load_cluster(w.grains, w.records, group, lanes);
                volume = lanes[3];
                const Pack total = load(w.gather_sum, group);
                for_each_grain_of(w, group, [&](std::size_t id, int lane) {
                    if (total[lane] > 0.0) eps[id] += profile.factor * volume[lane] * sum[lane] / total[lane];
                });
            });
        });
    });
}

std::int64_t bound_porosity(std::vector<double>& eps) {
    constexpr double rounding = 1e-12;
    const std::int64_t above =
        ordered_sum(eps.size(), std::int64_t{0}, [&](std::size_t j) { return eps[j] > 1.0 + rounding ? 1 : 0; });
    parallel_for(eps.size(), [&](std::size_t j) { eps[j] = std::min(eps[j], 1.0); });
    return above;
}

} // namespace plumb
