#include "schemes/sph_scene.hpp"

#include "core/initial_fields.hpp"
#include "sph/arrange_fluid.hpp"
#include "sph/lattice_rates.hpp"
#include "sph/vector_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

namespace {

// Shares of the five times: Morris, Fox & Zhu 1997, eq. 20 (0.25 h/c); of the stable step of the viscous operator, 1
// over its greatest rate (verification/step_limits), which disorder raises up to 1.55 times (verification/disorder); 1
// over the greatest rate of shifting, half of what is stable, with which no shift goes beyond the even place; Monaghan
// 1992 (0.25 sqrt(h/f)); Adami, Hu & Adams 2010, J. Comput. Phys. 229, 5011 (0.25, after Brackbill et al. 1992).
constexpr double acoustic_share = 0.25, viscous_share = 0.6, shifting_share = 1.0, force_share = 0.25,
                 capillary_share = 0.25;

// Skin of the neighbour lists in spacings: wider ones are renewed less often but hold more pairs out of reach.
constexpr double skin_in_spacings = 0.25;

/// Speed of sound that keeps density changes near 1 % and lets pressure keep up with viscosity: ten times the velocity,
/// ten times sqrt(pressure drop/rho), and acoustic Reynolds number h c/nu = 20. Where the particles feel gravity, ten
/// times the speed of a fall through the box too.
double automatic_sound_speed(Table& table, const SphFluid& f) {
    const double velocity = table.number("reference_velocity", positive);
    double drop = table.number_or("pressure_drop", 0.0, non_negative);
    if (table.has("pressure") && table.choice("pressure", {"full", "dynamic"}) == "full")
        drop = std::max(drop, 2.0 * f.density * f.domain.gravity.cwiseAbs().dot(f.domain.size));
    return std::max({10.0 * velocity, 10.0 * std::sqrt(drop / f.density), 20.0 * f.viscosity / (f.density * f.h)});
}

void read_numbers(Table& table, SphFluid& f) {
    f.density = table.number("density", positive);
    f.viscosity = table.number("viscosity", non_negative);
    f.spacing = table.number("spacing", positive);
    f.h = table.number("smoothing", {0.5, 10.0, false, false}) * f.spacing;
    f.mass = f.density * std::pow(f.spacing, f.dimensions);
    if (table.type("sound_speed") == toml::node_type::string) {
        table.choice("sound_speed", {"auto"});
        f.sound_speed = automatic_sound_speed(table, f);
    } else {
        f.sound_speed = table.number("sound_speed", positive);
    }
}

ViscousTerm read_viscous_term(Table& table, const TermScales& scales) {
    Table law = table.law("viscous_term");
    return std::visit([&](const auto& chosen) { return ViscousTerm(std::decay_t<decltype(chosen)>(scales)); },
                      make_family<ViscousTerm>(law));
}

void read_models(Table& table, SphFluid& f) {
    f.kernel = make_family<Kernel>(table.law("kernel"));
    f.equation_of_state = make_family<EquationOfState>(table.law("equation_of_state"));
    f.operators = make_family<Operators>(table.law("operators"));
    f.viscous_term = read_viscous_term(table, term_scales(f));
    if (std::holds_alternative<Inviscid>(f.viscous_term) != (f.viscosity == 0.0))
        table.fail("viscous_term", fmt::format("\"{}\" does not go with a viscosity of {} Pa s",
                                               law_name(f.viscous_term), f.viscosity));
    if (std::holds_alternative<DoubleGradient>(f.viscous_term) &&
        !std::holds_alternative<CorrectedOperators>(f.operators))
        table.fail("viscous_term", "\"double_gradient\" needs operators = \"corrected\"");
    const double delta = table.number_or("density_diffusion", 0.0, non_negative);
    const double alpha = table.number_or("artificial_viscosity", 0.0, non_negative);
    f.extras.diffusion = 2.0 * delta * f.h * f.sound_speed;
    f.extras.artificial = alpha * f.sound_speed * f.h / f.mass;
    if (table.has("shifting")) { // D = A h U (Lind et al. 2012; A = 4 in the form of Sun et al. 2017); 0 is none
        const double a = table.number("shifting", non_negative);
        f.shifting = a * f.h * table.number("reference_velocity", positive);
    }
    f.extras.softening_sq = 0.01 * f.h * f.h;
    f.clusters.reach = support(f.kernel) * f.h * greatest_growth(f.operators);
    f.clusters.skin = skin_in_spacings * f.spacing;
}

/// With "full" pressure the particles feel gravity; with "dynamic" the hydrostatic part is taken out of both.
void read_forces(Table& table, SphFluid& f) {
    const bool full = table.choice("pressure", {"full", "dynamic"}) == "full";
    f.body_force = full ? f.domain.gravity : Vec3::Zero();
    const Vec3 gravity = f.body_force;
    if (table.has("body_force")) f.body_force += table.components("body_force", f.dimensions);
    const Vec3 head = gravity * (f.density / (f.mass * f.sound_speed * f.sound_speed));
    f.extras.stratification = {head[0], head[1], head[2]};
    f.extras.stratified = gravity.norm() > 0.0;
}

/// The manufactured flow repeats itself along x and y after the same length.
void check_manufactured_box(const Table& table, const char* key, const Vec3& size) {
    if (size[0] != size[1])
        table.fail(key,
                   fmt::format("\"manufactured\" needs a square box; this one measures {} m along x and {} m along y",
                               size[0], size[1]));
}

/// Sources, if there are any.
void read_source(Table& table, SphFluid& f) {
    if (!table.has("source")) return;
    f.source = make_family<Source>(table.law("source"));
    if (std::holds_alternative<ManufacturedSource>(f.source)) check_manufactured_box(table, "source", f.domain.size);
}

/// Surface tension, if there is any; then, and only then, walls have a contact angle.
void read_surface(Table& table, SphFluid& f) {
    if (table.has("surface")) f.surface.law = make_family<SurfaceLaw>(table.law("surface"));
    const bool tense = !std::holds_alternative<NoSurfaceTension>(f.surface.law);
    for (const FluidWall& wall : f.walls)
        if (tense == std::isnan(wall.cos_contact))
            table.fail("surface", tense ? "a wall without contact_angle" : "none, but a wall has a contact_angle");
    if (!tense) return;
    if (!f.free_surface) table.fail("surface", "without free_surface = true there is none that could have a tension");
    if (!std::holds_alternative<PlainOperators>(f.operators))
        table.fail("surface", "surface tension needs operators = \"plain\"");
    f.surface.profile = colour_profile(f.kernel, f.dimensions);
}

/// The box must hold a whole number of spacings along every axis, and no more particles than an id can count.
void check_spacing(const Table& table, const SphFluid& f) {
    double count = 1.0;
    for (int c = 0; c < f.dimensions; ++c) {
        const double cells = f.domain.size[c] / f.spacing;
        if (std::abs(cells - std::nearbyint(cells)) > 1e-6 * cells || cells < 0.5)
            table.fail("spacing", fmt::format("the box measures {:.9g} spacings along {}; a whole number is needed",
                                              cells, axis_names[static_cast<std::size_t>(c)]));
        count *= cells;
    }
    if (count > 2e9) table.fail("spacing", fmt::format("{:.3g} particles; 2e9 are possible", count));
}

/// The part of the box that is filled: all of it, or what `fill` says; not the walls, nor behind open sides.
std::function<bool(const Vec3&)> filled_part(Table& table, const SphFluid& f) {
    std::optional<Fill> fill;
    if (table.has("fill")) fill = make_family<Fill>(table.law("fill"));
    return [fill, &f](const Vec3& x) {
        if (fill && !std::visit([&](const auto& part) { return part(x); }, *fill)) return false;
        return (f.walls.empty() || !is_solid(f.walls, x)) && !is_outside(f.open_sides, x);
    };
}

/// Every place beside the fluid must hold fluid, a wall or an open side, unless there is a free surface.
void check_enclosed(const Table& table, const SphFluid& f) {
    if (f.free_surface) return;
    std::array<std::int64_t, 3> n{1, 1, 1};
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        n[c] = std::llround(f.domain.size[static_cast<Eigen::Index>(c)] / f.spacing);
    const auto number = [&](const std::array<std::int64_t, 3>& cell) {
        return static_cast<std::size_t>(cell[0] + n[0] * (cell[1] + n[1] * cell[2]));
    };
    const auto cell_of = [&](std::size_t k) {
        std::array<std::int64_t, 3> cell{0, 0, 0};
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
            cell[c] = std::clamp<std::int64_t>(static_cast<std::int64_t>(f.x[c][k] / f.spacing), 0, n[c] - 1);
        return cell;
    };
    std::vector<bool> filled(static_cast<std::size_t>(n[0] * n[1] * n[2]), false);
    for (std::size_t k = 0; k < f.slots(); ++k) filled[number(cell_of(k))] = true;
    for (std::size_t k = 0; k < f.slots(); ++k)
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
            for (const int way : {-1, 1}) {
                std::array<std::int64_t, 3> beside = cell_of(k);
                beside[c] += way;
                Vec3 x = Vec3::Zero();
                for (int a = 0; a < f.dimensions; ++a)
                    x[a] = (static_cast<double>(beside[static_cast<std::size_t>(a)]) + 0.5) * f.spacing;
                if (f.domain.periodic[c]) beside[c] = (beside[c] + n[c]) % n[c];
                const bool inside = beside[c] >= 0 && beside[c] < n[c];
                if ((inside && filled[number(beside)]) || is_solid(f.walls, x) || is_outside(f.open_sides, x)) continue;
                table.fail("free_surface",
                           fmt::format("missing: the fluid ends at x = {:.4g}, y = {:.4g}, z = {:.4g} m, where there "
                                       "is neither a wall nor a periodic or open side",
                                       x[0], x[1], x[2]));
            }
}

void set_initial_state(Table& table, SphFluid& f) {
    Table arrange = table.law("arrange");
    const bool jittered = arrange.choice("law", {"lattice", "jittered"}) == "jittered";
    const double jitter = jittered ? arrange.number("jitter", {0.0, 0.5, true, false}) : 0.0;
    const auto seed = static_cast<std::uint64_t>(jittered ? arrange.integer("seed", 0) : 0);
    check_spacing(table, f);
    fill_box(f, jitter, seed, filled_part(table, f));
    const bool fed = f.free_surface && std::any_of(f.open_sides.begin(), f.open_sides.end(),
                                                   [](const OpenSide& side) { return side.is_inlet(); });
    if (f.slots() == 0 && !fed) // an empty vessel is filled by its inlet
        table.fail("arrange", "there is no place for the fluid: every place of the lattice is behind a wall, beyond an "
                              "open side or not in `fill`");
    line_walls(f);
    if (const auto narrow = fill_buffers(f))
        table.fail("spacing",
                   fmt::format("no row of particles fits into the open side \"{}\"", f.open_sides[*narrow].name));
    check_enclosed(table, f);
    const auto initial = make_family<InitialField>(table.law("initial"));
    if (std::holds_alternative<ManufacturedField>(initial)) check_manufactured_box(table, "initial", f.domain.size);
    const FluidNumbers numbers = fluid_numbers(f);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const Vec3 x = vector_at(f.x, k, f.dimensions);
        const FlowState state = std::visit([&](const auto& field) { return field(x, numbers); }, initial);
        for (int c = 0; c < f.dimensions; ++c) f.v[static_cast<std::size_t>(c)][k] = state.u[c];
        f.rho[k] = density_of_pressure(f, state.p);
        if (!(std::abs(f.rho[k] - f.density) < 0.5 * f.density)) // NaN too: Tait's law ends at -rho c^2/7
            table.fail("sound_speed", fmt::format("{:.6g} m/s are too few: the initial pressure of {:.6g} Pa would "
                                                  "change the density by more than half",
                                                  f.sound_speed, state.p));
    }
}

} // namespace

std::vector<FluidWall> read_fluid_walls(std::vector<Table>& tables, const Domain& domain) {
    std::vector<WallBody> bodies = make_walls(tables, domain.dimensions);
    std::vector<FluidWall> walls;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        FluidWall wall{std::move(bodies[k])};
        wall.slips = tables[k].choice("slip", {"no_slip", "free_slip"}) == "free_slip";
        if (std::holds_alternative<TriangleMesh>(wall.body.shape)) {
            if (domain.dimensions == 2) tables[k].fail("shape", "\"stl\" in a scene of two dimensions");
            wall.fluid_is_inside = tables[k].choice("fluid_side", {"inside", "outside"}) == "inside";
        }
        if (tables[k].has("contact_angle"))
            wall.cos_contact = std::cos(tables[k].number("contact_angle", {0.0, std::numbers::pi, true, true}));
        walls.push_back(std::move(wall));
    }
    return walls;
}

namespace {

OpenSide read_open_side(Table& table, const Domain& domain) {
    OpenSide side;
    side.name = table.text("name");
    side.point = table.components("point", domain.dimensions);
    side.normal = table.components("normal", domain.dimensions);
    if (!(side.normal.norm() > 0.0)) table.fail("normal", "is zero; expected a direction");
    side.normal.normalize();
    for (int c = 0; c < domain.dimensions; ++c)
        if (domain.periodic[static_cast<std::size_t>(c)] && side.normal[c] != 0.0)
            table.fail("normal", "points along a periodic side");
    side.averaging_time = table.number("averaging_time", positive);
    return side;
}

} // namespace

std::vector<OpenSide> read_open_sides(std::vector<Table>& inlets, std::vector<Table>& outlets, const Domain& domain) {
    std::vector<OpenSide> sides;
    for (Table& table : inlets) {
        sides.push_back(read_open_side(table, domain));
        sides.back().profile = make_family<InletProfile>(table.law("profile"));
        if (table.has("rigid")) sides.back().rigid = table.flag("rigid");
        if (table.has("flow_rate")) sides.back().flow_rate = table.number("flow_rate", positive);
        if (!table.has("opens")) continue;
        Table opens = table.table("opens");
        sides.back().opens_from = opens.number("from", non_negative);
        sides.back().opens_over = opens.number("over", non_negative);
    }
    for (Table& table : outlets) {
        sides.push_back(read_open_side(table, domain));
        sides.back().pressure = table.number("pressure");
        if (table.has("even")) sides.back().even = table.flag("even");
        if (sides.back().even != sides[inlets.size()].even)
            table.fail("even", "outlets that let out together what comes in have to be so all of them");
    }
    return sides;
}

SphFluid read_sph_fluid(Table& table, const Domain& domain, const std::vector<FluidWall>& walls,
                        const std::vector<OpenSide>& open_sides) {
    SphFluid f;
    f.dimensions = domain.dimensions;
    f.domain = domain;
    table.choice("method", {"sph"});
    read_numbers(table, f);
    read_models(table, f);
    read_forces(table, f);
    read_source(table, f);
    f.free_surface = table.has("free_surface") && table.flag("free_surface");
    if (f.free_surface && !f.extras.stratified && f.domain.gravity.norm() > 0.0)
        table.fail("pressure", "\"dynamic\" leaves no gravity to hold a free surface");
    if (table.has("filling_time")) f.filling_time = table.number("filling_time", positive);
    f.background_pressure = table.number_or("background_pressure", 0.0, non_negative);
    if (f.background_pressure > 0.0 && f.free_surface)
        table.fail("background_pressure", "blows up a fluid with a free surface");
    f.keeps_mean_density = table.has("keep_mean_density") && table.flag("keep_mean_density");
    if (f.keeps_mean_density && (f.free_surface || !open_sides.empty()))
        table.fail("keep_mean_density", "only a closed volume keeps its mean density");
    f.walls = walls;
    read_surface(table, f);
    f.open_sides = open_sides;
    if (std::holds_alternative<CorrectedOperators>(f.operators)) {
        if (f.free_surface) table.fail("operators", "\"corrected\" knows no free surface");
        if (std::holds_alternative<DoubleGradient>(f.viscous_term) && !(walls.empty() && open_sides.empty()))
            table.fail("viscous_term", "\"double_gradient\" knows no walls or open sides");
    }
    set_initial_state(table, f);
    return f;
}

namespace {

/// The plain midpoint step lets undamped sound grow by (omega dt)^4/4 a step (advance_fluid.hpp). Viscosity takes that
/// away if the step is short enough, dt^3 < 4 beta/omega^4 with beta about nu/h^2 and omega about c/h for the least
/// stable wave: from h c/nu = 100 on the limit shrinks with the third root of nu, down to a tenth, at which sound grows
/// e-fold in no less than 2.5e5 h/c. Density diffusion damps far more than that.
double sound_share(const SphFluid& f) {
    constexpr double safe_reynolds = 100.0, least = 0.1, least_diffusion = 0.05;
    if (f.memory > 0.0 || f.extras.diffusion >= 2.0 * least_diffusion * f.h * f.sound_speed) return 1.0;
    const double nu = f.viscosity / f.density + artificial_nu(f);
    return std::clamp(std::cbrt(safe_reynolds * nu / (f.h * f.sound_speed)), least, 1.0);
}

} // namespace

std::vector<StepLimit> fluid_limits(const SphFluid& f) {
    const double none = std::numeric_limits<double>::infinity();
    const double damping = greatest_viscous_rate(f), diffusion = greatest_diffusion_rate(f);
    const double force = f.body_force.norm();
    const double shift = f.shifting > 0.0 ? f.shifting * greatest_concentration_rate(f) : 0.0;
    std::vector<StepLimit> limits{
        {"acoustic", acoustic_share * sound_share(f) * f.h / f.sound_speed,
         "0.25 h/c, less where nothing damps sound (integrator midpoint, no diffusion, h c/nu > 100)"},
        {"viscous", damping > 0.0 ? viscous_share / (damping * (1.0 + f.memory)) : none,
         "0.6 over the greatest rate of the viscous operator on a lattice"},
        {"shifting", shift > 0.0 ? shifting_share / shift : none,
         "1 over the greatest rate at which shifting evens out the concentration"},
        {"diffusion", diffusion > 0.0 ? viscous_share / (diffusion * (1.0 + f.memory)) : none,
         "0.6 over the greatest rate of density diffusion on a lattice"},
        {"force", force > 0.0 ? force_share * std::sqrt(f.h / force) : none, "0.25 sqrt(h/f)"}};
    if (const double tension = surface_tension(f.surface); tension > 0.0)
        limits.push_back(
            {"capillary",
             capillary_share * std::sqrt(f.density * std::pow(f.h, 3) / (2.0 * std::numbers::pi * tension)),
             "0.25 sqrt(rho h^3/(2 pi tension)): waves as short as h"});
    return limits;
}

} // namespace plumb
