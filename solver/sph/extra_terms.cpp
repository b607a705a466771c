#include "sph/sweep.hpp"

namespace plumb::fluid_sweep {

namespace {

using Diffusion = std::variant<NoTerm, DensityDiffusion<false>, DensityDiffusion<true>>;
using Artificial = std::variant<NoTerm, ArtificialViscosity>;
template <int d> using Along = std::variant<NoTerm, AlongSpread<d>>;

/// Among grains it is the fluid's own density that diffuses, in a pass of its own (coupling/own_density.hpp).
Diffusion diffusion_of(const SphFluid& f) {
    const Extras& e = f.extras;
    if (e.diffusion == 0.0 || f.among_grains()) return NoTerm{};
    if (e.stratified) return DensityDiffusion<true>(e);
    return DensityDiffusion<false>(e);
}

} // namespace

template <int d> void add_extras(const SphFluid& f, std::size_t cluster, const Field<Pack>& slopes, Sums<d>& sums) {
    if (f.extras.idle() && f.shifting == 0.0) return;
    const Artificial artificial =
        f.extras.artificial != 0.0 ? Artificial(ArtificialViscosity(f.extras)) : Artificial(NoTerm{});
    const Along<d> along = f.shifting > 0.0 ? Along<d>(AlongSpread<d>{sums.spread}) : Along<d>(NoTerm{});
    std::visit(
        [&](const auto&... terms) {
            add_over_neighbours<d>(f.clusters, cluster, KeptSlope{slopes.data()}, sums, terms...);
        },
        diffusion_of(f), artificial, along);
}

template void add_extras<2>(const SphFluid&, std::size_t, const Field<Pack>&, Sums<2>&);
template void add_extras<3>(const SphFluid&, std::size_t, const Field<Pack>&, Sums<3>&);

} // namespace plumb::fluid_sweep
