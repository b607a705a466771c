// The [grains] tables, from keys to grains at rest or in motion.
#include "dem/arrange.hpp"

#include "core/sphere.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace plumb {

namespace {

GrainGroup make_group(Table& table, bool named, const std::vector<GrainGroup>& others) {
    GrainGroup group;
    group.name = named ? table.text("name") : table.text_or("name", "grains");
    if (group.name.empty()) table.fail("name", "is empty");
    for (const GrainGroup& other : others)
        if (other.name == group.name) table.fail("name", fmt::format("\"{}\" is used by two groups", group.name));
    group.density = table.number("density", positive);
    group.rotation = !table.has("rotation") || table.flag("rotation");
    if (table.has("motion")) {
        const std::string motion = table.choice("motion", {"free", "fixed", "block"});
        group.motion = motion == "free" ? Motion::free : (motion == "fixed" ? Motion::fixed : Motion::block);
    }
    return group;
}

/// Per grain what the file of places says, and which columns of it the laws use.
struct Listed {
    std::vector<double> diameter; // [m]; empty unless the law is "file"
    std::vector<Vec3> v;          // [m/s]; empty unless the law is "file"
};

Listed listed_values(const Arrangement& arrangement, const DiameterLaw* diameters, const VelocityLaw* velocity,
                     Table& table) {
    const auto* places = std::get_if<FilePlaces>(&arrangement);
    const bool lists_diameter = diameters != nullptr && std::holds_alternative<FileDiameters>(*diameters);
    const bool lists_velocity = velocity != nullptr && std::holds_alternative<FileVelocity>(*velocity);
    if (places == nullptr) {
        if (lists_diameter) table.fail("diameter", "the law \"file\" needs the arrangement \"file\"");
        if (lists_velocity) table.fail("velocity", "the law \"file\" needs the arrangement \"file\"");
        return {};
    }
    const Csv& csv = places->csv;
    std::vector<std::string_view> used{"x", "y", "z"};
    Listed listed;
    if (lists_diameter) {
        used.emplace_back("diameter");
        listed.diameter = csv.column("diameter", "m");
        for (std::size_t i = 0; i < listed.diameter.size(); ++i)
            if (!(listed.diameter[i] > 0.0))
                csv.fail(i, fmt::format("the diameter {} is not positive", listed.diameter[i]));
    }
    if (lists_velocity) {
        used.insert(used.end(), {"vx", "vy", "vz"});
        const auto &vx = csv.column("vx", "m/s"), &vy = csv.column("vy", "m/s"), &vz = csv.column("vz", "m/s");
        for (std::size_t i = 0; i < vx.size(); ++i) listed.v.emplace_back(vx[i], vy[i], vz[i]);
    }
    csv.allow_only(used);
    return listed;
}

std::vector<double> drawn_radii(const DiameterLaw& law, std::size_t count, const Listed& listed) {
    return std::visit(
        [&](const auto& diameter) {
            Random random = random_stream(diameter.seed, Stream::diameters);
            std::vector<double> radius(count);
            for (std::size_t i = 0; i < count; ++i)
                radius[i] = 0.5 * diameter(random, listed.diameter.empty() ? 0.0 : listed.diameter[i]);
            return radius;
        },
        law);
}

std::vector<Vec3> drawn_velocities(const VelocityLaw& law, const std::vector<double>& radius, const Listed& listed) {
    std::vector<Vec3> v(radius.size());
    std::visit(
        [&](const auto& velocity) {
            Random random = random_stream(velocity.seed, Stream::velocities);
            for (std::size_t i = 0; i < v.size(); ++i)
                v[i] = velocity(random, listed.v.empty() ? Vec3::Zero() : listed.v[i]);
        },
        law);
    if (!std::holds_alternative<MaxwellVelocity>(law)) return v;
    for (int pass = 0; pass < 2; ++pass) { // the second pass removes the round-off that the first one leaves
        Vec3 momentum = Vec3::Zero();
        double volume = 0.0; // stands for mass: the group shares its density
        for (std::size_t i = 0; i < v.size(); ++i) {
            momentum += sphere_volume(2.0 * radius[i]) * v[i];
            volume += sphere_volume(2.0 * radius[i]);
        }
        for (Vec3& each : v) each -= momentum / volume;
    }
    return v;
}

void add_group(Grains& grains, std::vector<GrainGroup>& groups, Table& table, bool named, const Domain& domain,
               const std::vector<WallBody>& walls) {
    groups.push_back(make_group(table, named, groups));
    const auto arrangement = make_family<Arrangement>(table.law("arrange"));
    if (std::holds_alternative<NoGrains>(arrangement)) return; // sizes and velocities are the injector's
    const DiameterLaw diameters = make_diameters(table);
    const VelocityLaw velocity = make_velocity(table);
    if (groups.back().motion == Motion::block && !std::holds_alternative<EqualVelocity>(velocity))
        table.fail("velocity", "the grains of a block move with one velocity; expected three numbers");
    const Vec3 omega = table.has("angular_velocity") ? table.vector("angular_velocity") : Vec3::Zero();

    const Listed listed = listed_values(arrangement, &diameters, &velocity, table);
    const std::size_t count = std::visit([&](const auto& law) { return law.count(domain); }, arrangement);
    if (count == 0) table.fail("arrange", "makes no grains: the region is smaller than a cell");
    const std::vector<double> radius = drawn_radii(diameters, count, listed);
    const Site site{domain, grains, walls};
    const std::vector<Vec3> x = std::visit([&](const auto& law) { return law(site, radius); }, arrangement);
    const std::vector<Vec3> v = drawn_velocities(velocity, radius, listed);
    const auto group = static_cast<std::int32_t>(groups.size() - 1);
    for (std::size_t i = 0; i < count; ++i)
        add_grain(grains, groups, group, radius[i], domain.wrapped(x[i]), v[i], omega);
}

} // namespace

void add_grains(Grains& grains, std::vector<GrainGroup>& groups, std::vector<Table>& tables, const Domain& domain,
                const std::vector<WallBody>& walls) {
    for (Table& table : tables) add_group(grains, groups, table, tables.size() > 1, domain, walls);
}

} // namespace plumb
