#include "sph/arrange_fluid.hpp"

#include "core/random.hpp"

#include <cmath>

namespace plumb {

BoxFill::BoxFill(Table& table) {
    const int dimensions = table.length("lower") == 2 ? 2 : 3;
    lower = table.components("lower", dimensions);
    upper = table.components("upper", dimensions);
}

EllipsoidFill::EllipsoidFill(Table& table) {
    const int dimensions = table.length("centre") == 2 ? 2 : 3;
    centre = table.components("centre", dimensions);
    semi_axes = table.components("semi_axes", dimensions, positive);
    if (dimensions == 2) semi_axes[2] = 1.0; // z is 0
}

void fill_box(SphFluid& f, double jitter, std::uint64_t seed, const std::function<bool(const Vec3&)>& is_fluid) {
    std::array<std::int64_t, 3> n{1, 1, 1};
    for (int c = 0; c < f.dimensions; ++c) n[static_cast<std::size_t>(c)] = std::llround(f.domain.size[c] / f.spacing);
    Random random(static_cast<std::int64_t>(seed));
    for (VectorField* field : {&f.x, &f.v, &f.a, &f.x_listed})
        for (Field<double>& component : *field) component.clear();
    for (std::int64_t at = 0; at < n[0] * n[1] * n[2]; ++at) {
        const std::array<std::int64_t, 3> cell{at % n[0], at / n[0] % n[1], at / (n[0] * n[1])};
        Vec3 middle = Vec3::Zero(), moved = Vec3::Zero();
        for (int c = 0; c < f.dimensions; ++c) {
            const double centre = static_cast<double>(cell[static_cast<std::size_t>(c)]) + 0.5;
            middle[c] = centre * f.spacing;
            moved[c] = (centre + (jitter > 0.0 ? random.uniform(-jitter, jitter) : 0.0)) * f.spacing;
        }
        if (!is_fluid(middle)) continue;
        const Vec3 place = is_fluid(moved) ? moved : middle;
        for (int c = 0; c < f.dimensions; ++c) f.x[static_cast<std::size_t>(c)].push_back(place[c]);
    }
    const std::size_t count = f.x[0].size();
    for (VectorField* field : {&f.v, &f.a, &f.x_listed})
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) (*field)[c].assign(count, 0.0);
    f.rho.assign(count, f.density);
    f.drho.assign(count, 0.0);
    f.id.resize(count);
    for (std::size_t k = 0; k < count; ++k) f.id[k] = static_cast<std::int32_t>(k);
    f.next_id = static_cast<std::int32_t>(count);
    f.particles = count;
}

} // namespace plumb
