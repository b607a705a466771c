#include "sph/corrected_sweep.hpp"
#include "sph/sweep.hpp"
#include "sph/variable_sweep.hpp"
#include "sph/vector_at.hpp"

namespace plumb {

void evaluate_terms(SphFluid& f) {
    if (std::holds_alternative<CorrectedOperators>(f.operators))
        evaluate_corrected(f);
    else if (std::holds_alternative<VariableOperators>(f.operators))
        evaluate_variable(f);
    else
        std::visit([&](const auto& kernel) { evaluate_with<std::decay_t<decltype(kernel)>>(f); }, f.kernel);
    correct_continuity(f);
    add_surface_tension(f);
}

void keep_mean_density(SphFluid& f) {
    if (!f.keeps_mean_density) return;
    const std::vector<std::int32_t> slots = ordered_slots(f);
    const double sum =
        ordered_sum(slots.size(), 0.0, [&](std::size_t q) { return f.drho[static_cast<std::size_t>(slots[q])]; });
    const double mean = sum / static_cast<double>(slots.size());
    parallel_for(f.slots(), [&](std::size_t k) { f.drho[k] -= mean; });
}

void add_sources(SphFluid& f, double time) {
    if (std::holds_alternative<NoSource>(f.source)) return;
    const FluidNumbers numbers = fluid_numbers(f);
    parallel_for(f.slots(), [&](std::size_t k) {
        const Vec3 x = vector_at(f.x, k, f.dimensions);
        const SourceRates rates = std::visit([&](const auto& law) { return law(x, time, numbers); }, f.source);
        for (int c = 0; c < f.dimensions; ++c) f.a[static_cast<std::size_t>(c)][k] += rates.acceleration[c];
        f.drho[k] += rates.density_rate;
    });
}

} // namespace plumb
