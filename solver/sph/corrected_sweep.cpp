#include "sph/corrected_sweep.hpp"

#include "sph/corrected_terms.hpp"
#include "sph/sweep.hpp"

namespace plumb {

namespace fluid_sweep {

namespace {

/// Gradients of a particle.
template <class T, int d> struct Gradients {
    Components<Components<T, d>, d> v; // rows: components of v
    Components<T, d> rho;
};

/// Numbers per record in CorrectedFields::gradients: d (d + 1), to whole cache lines.
template <int d> constexpr std::size_t corrected_stride = d == 2 ? 8 : 16;

/// Calls body(number) for every number of the gradients, in the order in which they are kept.
template <int d, class G, class Body> [[gnu::always_inline]] inline void for_numbers(G& gradients, Body&& body) {
    for_components<d>([&](auto& row) { for_components<d>(body, row); }, gradients.v);
    for_components<d>(body, gradients.rho);
}

template <int d> void store_gradients(SphFluid& f, std::size_t cluster, const Gradients<Pack, d>& gradients) {
    std::size_t number = 0;
    for_numbers<d>(gradients, [&](const Pack& value) {
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const auto record = static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane]);
            f.corrected.gradients[corrected_stride<d> * record + number] = value[static_cast<int>(lane)];
        }
        ++number;
    });
}

template <int d> Gradients<Pack, d> load_gradients(const SphFluid& f, std::size_t cluster) {
    Gradients<Pack, d> gradients;
    std::size_t number = 0;
    for_numbers<d>(gradients, [&](Pack& value) {
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const auto record = static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane]);
            value[static_cast<int>(lane)] = f.corrected.gradients[corrected_stride<d> * record + number];
        }
        ++number;
    });
    return gradients;
}

/// Those of one record, eight times.
template <int d> [[gnu::always_inline]] inline Gradients<Pack, d> spread_gradients(const double* numbers) {
    Gradients<Pack, d> gradients;
    for_numbers<d>(
        gradients, [&](Pack & value) __attribute__((always_inline)) { value = broadcast<Pack>(*numbers++); });
    return gradients;
}

/// Calls body(field, component) for the components of the inverse.
template <int d, class M, class Body> void for_inverse(SphFluid& f, M& inverse, Body&& body) {
    auto& fields = f.corrected.inverses;
    body(fields[0], inverse.xx), body(fields[1], inverse.yy), body(fields[2], inverse.xy);
    if constexpr (d == 3) body(fields[3], inverse.zz), body(fields[4], inverse.xz), body(fields[5], inverse.yz);
}

template <int d> void resize_fields(SphFluid& f) {
    renew_size(f.corrected.gradients, corrected_stride<d> * f.clusters.records.size());
    Symmetric<Pack, d> sizes{};
    for_inverse<d>(f, sizes, [&](Field<double>& field, const Pack&) { renew_size(field, f.slots()); });
}

/// Rates and gradients of a cluster from its sums.
template <int d> void store_corrected_rates(SphFluid& f, std::size_t cluster, double gradient, const Sums<d>& sums) {
    Pack lanes[8];
    load_cluster(f.clusters, cluster, lanes);
    const Pack scale = broadcast<Pack>(gradient), rho = broadcast<Pack>(f.mass) / lanes[7];
    const Pack pair_scale = broadcast<Pack>(f.mass * gradient);
    const Symmetric<Pack, d> inverse = inverse_or_plain<d>(sums.moment, scale);
    Gradients<Pack, d> gradients;
    for_components<d>([&](auto& row, const auto& sum) { row = product<d>(inverse, sum); }, gradients.v, sums.grad_v);
    gradients.rho = product<d>(inverse, sums.grad_rho);
    const Components<Pack, d> grad_p = product<d>(inverse, sums.grad_p);
    std::size_t axis = 0;
    for_components<d>(
        [&](const Pack& slope, const Pack& sum, const Pack& spread, const Components<Pack, d>& row) {
            const double force = f.body_force[static_cast<Eigen::Index>(axis)];
            store(f.a[axis], cluster, pair_scale * sum - slope / rho + broadcast<Pack>(force));
            if (f.shifting > 0.0) {
                store(f.spread[axis], cluster, scale * spread);
                store(f.dv_spread[axis], cluster, scale * dot(row, sums.spread));
            }
            ++axis;
        },
        grad_p, sums.acceleration, sums.spread, gradients.v);
    Pack divergence = gradients.v.x.x + gradients.v.y.y;
    if constexpr (d == 3) divergence += gradients.v.z.z;
    store(f.drho, cluster, -rho * divergence);
    if (f.shifting > 0.0) {
        store(f.drho_spread, cluster, scale * dot(gradients.rho, sums.spread));
        store(f.completeness, cluster, scale * sums.completeness * broadcast<Pack>(1.0 / d));
    }
    store_gradients<d>(f, cluster, gradients);
    for_inverse<d>(f, inverse, [&](Field<double>& field, const Pack& value) { store(field, cluster, value); });
}

template <class KernelLaw, int d> void first_pass(SphFluid& f) {
    const double gradient = KernelLaw::sigma(d) / std::pow(f.h, d + 2);
    const AnyPairViscosity viscous(f.viscous_term);
    const auto artificial = [&, term = ArtificialViscosity(f.extras) ](const auto& p, const Side& a, const Side& b,
                                                                       Sums<d>& sums) __attribute__((always_inline)) {
        if (term.half != 0.0) term(p, a, b, sums);
    };
    const MomentAndPressure moment{f.mass};
    const FieldGradients gradients{f.mass};
    for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            Sums<d> sums = no_sums<d>();
            add_over_neighbours<d>(f.clusters, c, Slope<KernelLaw>(f.h), sums, moment, viscous, artificial,
                                   ConcentrationGradient{}, gradients);
            store_corrected_rates<d>(f, c, gradient, sums);
        }
    });
}

/// Sums of the second pass, without the correction's scale.
template <int d> struct SecondSums {
    Components<Pack, d> laplacian; // sum V (grad v_b - grad v_a) . B dx f
    Pack diffusion;                // sum V [rho_b - rho_a - (grad rho_a + grad rho_b) . (x_b - x_a)/2] f
};

template <class KernelLaw, int d> SecondSums<d> second_sums(SphFluid& f, std::size_t cluster) {
    Pack lanes[8];
    load_cluster(f.clusters, cluster, lanes);
    const auto x = components<d>(lanes[0], lanes[1], lanes[2]);
    const Gradients<Pack, d> own = load_gradients<d>(f, cluster);
    Symmetric<Pack, d> inverse{};
    for_inverse<d>(f, inverse, [&](const Field<double>& field, Pack& value) { value = load(field, cluster); });
    const Pack scale = broadcast<Pack>(1.0 / f.h), m = broadcast<Pack>(f.mass), m_over_volume = m / lanes[7];
    const Pack zero = broadcast<Pack>(0.0), half = broadcast<Pack>(0.5);
    SecondSums<d> sums{components<d>(zero, zero, zero), zero};
    for (const std::int32_t neighbour : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(neighbour);
        const FluidRecord& b = f.clusters.records[r];
        const auto source = static_cast<std::size_t>(f.clusters.image_of[r]); // a gradient is the same in all images
        const auto there = spread_gradients<d>(&f.corrected.gradients[corrected_stride<d> * source]);
        const auto dx = components<d>(x.x - b.x, x.y - b.y, lanes[2] - b.z);
        const Pack slope = KernelLaw::f(square_root(dot(dx, dx)) * scale), volume = broadcast<Pack>(b.volume);
        const Components<Pack, d> direction = product<d>(inverse, dx);
        for_components<d>(
            [&](Pack & sum, const Components<Pack, d>& at_b, const Components<Pack, d>& at_a) __attribute__((
                always_inline)) { sum += (slope * volume) * (dot(at_b, direction) - dot(at_a, direction)); },
            sums.laplacian, there.v, own.v);
        const Pack linear = dot(there.rho, dx) + dot(own.rho, dx); // dx = -(x_b - x_a)
        sums.diffusion += slope * (m - volume * m_over_volume + half * volume * linear);
    }
    return sums;
}

template <class KernelLaw, int d> void second_pass(SphFluid& f) {
    const auto* viscous = std::get_if<DoubleGradient>(&f.viscous_term);
    const double viscosity = viscous != nullptr ? viscous->viscosity : 0.0;
    if (viscosity == 0.0 && f.extras.diffusion == 0.0) return;
    const Pack diffusion = broadcast<Pack>(f.extras.diffusion * KernelLaw::sigma(d) / std::pow(f.h, d + 2));
    parallel_chunks(
        f.clusters.count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const SecondSums<d> sums = second_sums<KernelLaw, d>(f, c);
                Pack lanes[8];
                load_cluster(f.clusters, c, lanes);
                const Pack over_rho = lanes[7] * broadcast<Pack>(viscosity / f.mass);
                std::size_t axis = 0;
                for_components<d>([&](const Pack& sum) { add(f.a[axis++], c, over_rho * sum); }, sums.laplacian);
                add(f.drho, c, -diffusion * sums.diffusion);
            }
        },
        16);
}

template <class KernelLaw, int d> void evaluate_passes(SphFluid& f) {
    resize_fields<d>(f);
    first_pass<KernelLaw, d>(f);
    second_pass<KernelLaw, d>(f);
}

} // namespace

} // namespace fluid_sweep

void evaluate_corrected(SphFluid& f) {
    std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            f.dimensions == 2 ? fluid_sweep::evaluate_passes<KernelLaw, 2>(f)
                              : fluid_sweep::evaluate_passes<KernelLaw, 3>(f);
        },
        f.kernel);
}

} // namespace plumb
