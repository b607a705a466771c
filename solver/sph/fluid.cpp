#include "sph/fluid.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Every field of every particle, for whatever has to move with it.
template <class Visit> void for_each_moving_field(SphFluid& f, Visit&& visit) {
    // not without memory, and not before the first evaluation of a coupled scene
    const bool remembers = f.memory > 0.0 && f.drho_before.size() == f.drho.size();
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        for (VectorField* field : {&f.x, &f.v, &f.a, &f.x_listed}) visit((*field)[c]);
    visit(f.rho);
    visit(f.drho);
    if (!f.lengths.omega.empty()) visit(f.lengths.omega);
    if (f.among_grains()) visit(f.share);
    if (!remembers) return;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) visit(f.a_before[c]);
    visit(f.drho_before);
}

void permute(Field<double>& field, const std::vector<std::int32_t>& from, Field<double>& spare) {
    renew_size(spare, from.size());
    parallel_for(from.size(), [&](std::size_t k) { spare[k] = field[static_cast<std::size_t>(from[k])]; });
    std::swap(field, spare);
}

/// Puts positions along an axis inside the box, if it is periodic there.
void wrap(Field<double>& x, const Domain& domain, std::size_t axis) {
    if (!domain.periodic[axis]) return;
    const double side = domain.size[static_cast<Eigen::Index>(axis)];
    parallel_for(x.size(), [&](std::size_t k) {
        x[k] -= side * std::floor(x[k] / side);
        if (x[k] >= side) x[k] = 0.0; // the product is rounded
    });
}

/// New lists for the positions `at`; all fields are put into the new order.
void rebuild_for(SphFluid& f, const VectorField& at) {
    const ClusterOrder order = rebuild(f.clusters, {at, f.id, f.boundary.x_listed}, f.domain, f.spacing);
    list_mirrors(f);
    for_each_moving_field(f, [&](Field<double>& field) { permute(field, order.from, f.spare); });
    std::vector<std::int32_t> id(order.from.size());
    for (std::size_t k = 0; k < id.size(); ++k)
        id[k] = order.copy[k] != 0 ? -1 : f.id[static_cast<std::size_t>(order.from[k])];
    f.id = std::move(id);
    if (f.shifting == 0.0) return; // these are made anew by the next evaluation
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        for (VectorField* field : {&f.spread, &f.dv_spread}) (*field)[c].assign(f.id.size(), 0.0);
    f.drho_spread.assign(f.id.size(), 0.0);
    f.completeness.assign(f.id.size(), 1.0);
}

} // namespace

std::vector<std::int32_t> ordered_slots(const SphFluid& f) {
    std::vector<std::int32_t> slot_of(static_cast<std::size_t>(f.next_id), -1), slots;
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) slot_of[static_cast<std::size_t>(f.id[k])] = static_cast<std::int32_t>(k);
    slots.reserve(f.particles);
    for (const std::int32_t slot : slot_of)
        if (slot >= 0) slots.push_back(slot);
    return slots;
}

void append_particle(SphFluid& f, const Vec3& x, const Vec3& v, double rho) {
    for_each_moving_field(f, [](Field<double>& field) { field.push_back(0.0); });
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
        f.x[c].back() = f.x_listed[c].back() = x[static_cast<Eigen::Index>(c)];
        f.v[c].back() = v[static_cast<Eigen::Index>(c)];
    }
    f.rho.back() = rho;
    if (!f.lengths.omega.empty()) f.lengths.omega.back() = 1.0;
    f.id.push_back(f.next_id++);
    ++f.particles;
}

void renew_lists(SphFluid& f) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
        for (Field<double>* x : {&f.x[c], &f.boundary.x[c], &f.boundary.mirror[c]}) wrap(*x, f.domain, c);
        f.x_listed[c] = f.x[c];
        f.boundary.x_listed[c] = f.boundary.x[c];
        f.boundary.mirror_listed[c] = f.boundary.mirror[c];
    }
    f.boundary.travelled = 0.0;
    rebuild_for(f, f.x_listed);
}

void restore_lists(SphFluid& f) { rebuild_for(f, f.x_listed); }

} // namespace plumb
