#include "sph/wall_particles.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace plumb {

namespace {

/// A wall that a place lies behind.
struct Behind {
    const FluidWall* wall;
    Vec3 normal;  // into the fluid
    double depth; // below the surface [m]
};

/// Solid angle of all triangles seen from x, over 4 pi: 1 inside a closed mesh, 0 outside (van Oosterom & Strackee
/// 1983, IEEE Trans. Biomed. Eng. 30, 125).
double winding_number(const Triangles& mesh, const Vec3& x) {
    double sum = 0.0;
    for (const auto& corners : mesh.corners) {
        const Vec3 a = mesh.points[static_cast<std::size_t>(corners[0])] - x,
                   b = mesh.points[static_cast<std::size_t>(corners[1])] - x,
                   c = mesh.points[static_cast<std::size_t>(corners[2])] - x;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}

bool is_behind(const FluidWall& wall, const TriangleMesh& mesh, const Vec3& x) {
    return (std::abs(winding_number(mesh.triangles(), x)) > 0.5) != wall.fluid_is_inside;
}

/// The surfaces of a wall, displaced as at `time`, that the place lies behind; of a mesh, not those farther than
/// `near`.
void find_behind(const FluidWall& wall, const Vec3& place, double time, double near, std::vector<Behind>& found) {
    const double far = std::numeric_limits<double>::infinity();
    const Vec3 x = place - wall.body.velocity * time;
    if (const auto* mesh = std::get_if<TriangleMesh>(&wall.body.shape)) {
        bool close = near == far;
        if (!close) mesh->touch(x, near, [&](const WallPoint& /*p*/) { close = true; });
        if (!close || !is_behind(wall, *mesh, x)) return;
        Behind nearest{&wall, Vec3::Zero(), far};
        mesh->touch(x, far, [&](const WallPoint& p) {
            if (p.distance < nearest.depth) nearest = {&wall, -p.normal, p.distance};
        });
        found.push_back(nearest);
        return;
    }
    wall.body.touch(x, far, 0.0, [&](const WallPoint& p) {
        if (p.distance < 0.0) found.push_back({&wall, p.normal, -p.distance});
    });
}

std::vector<Behind> walls_before(const std::vector<FluidWall>& walls, const Vec3& x, double time = 0.0,
                                 double near = std::numeric_limits<double>::infinity()) {
    std::vector<Behind> found;
    for (const FluidWall& wall : walls) find_behind(wall, x, time, near, found);
    return found;
}

/// Velocity with which the particles of a wall move: a plane or a cylinder that slides along itself stays where it is.
Vec3 displacement_velocity(const FluidWall& wall) {
    const Vec3& v = wall.body.velocity;
    if (const auto* plane = std::get_if<Plane>(&wall.body.shape)) return v.dot(plane->normal) * plane->normal;
    if (const auto* cylinder = std::get_if<Cylinder>(&wall.body.shape))
        return v - v.dot(cylinder->axis) * cylinder->axis;
    return v;
}

/// Reflections in all walls: the no-slip ones turn the velocity round as often as there are, about their mean velocity;
/// each free-slip one turns round the component normal to it.
Continuation continuation(const std::vector<Behind>& behind, bool all_slip) {
    Continuation rule;
    Vec3 mean = Vec3::Zero();
    int sticking = 0;
    for (const Behind& b : behind)
        if (!(all_slip || b.wall->slips)) mean += b.wall->body.velocity, ++sticking;
    if (sticking % 2 == 1) {
        rule.turn = -Eigen::Matrix3d::Identity();
        rule.offset = 2.0 * mean / sticking;
    }
    for (const Behind& b : behind) {
        if (!(all_slip || b.wall->slips)) continue;
        const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() - 2.0 * b.normal * b.normal.transpose();
        rule.offset = turn * rule.offset + 2.0 * b.normal.dot(b.wall->body.velocity) * b.normal;
        rule.turn = turn * rule.turn;
    }
    return rule;
}

BoundaryParticle wall_particle(const SphFluid& f, const Vec3& x, const std::vector<Behind>& behind) {
    Vec3 mirror = x, velocity = Vec3::Zero();
    for (const Behind& b : behind) {
        mirror += 2.0 * b.depth * b.normal;
        velocity += displacement_velocity(*b.wall) / static_cast<double>(behind.size());
    }
    for (const OpenSide& side : f.open_sides) // beside a buffer there is no fluid: that in front of the plane will do
        if (side.distance(mirror) < 0.0) mirror = side.reflected(mirror);
    const Behind& deepest = *std::max_element(behind.begin(), behind.end(),
                                              [](const Behind& a, const Behind& b) { return a.depth < b.depth; });
    return {x,
            mirror,
            velocity,
            velocity,
            -1,
            continuation(behind, false),
            continuation(behind, true),
            deepest.normal,
            deepest.wall->cos_contact};
}

} // namespace

bool is_solid(const std::vector<FluidWall>& walls, const Vec3& x) { return !walls_before(walls, x).empty(); }

Penetration penetration(const std::vector<FluidWall>& walls, const Vec3& x, double time, double near) {
    Penetration deepest;
    for (const Behind& b : walls_before(walls, x, time, near))
        if (b.depth > deepest.depth) deepest = {b.depth, b.normal, b.wall->body.velocity};
    return deepest;
}

void for_each_cell(const SphFluid& f, std::int64_t margin, const std::function<void(const Vec3&)>& visit) {
    std::array<std::int64_t, 3> first{0, 0, 0}, last{1, 1, 1};
    for (int c = 0; c < f.dimensions; ++c) {
        const auto axis = static_cast<std::size_t>(c);
        const std::int64_t outside = f.domain.periodic[axis] ? 0 : margin;
        first[axis] = -outside;
        last[axis] = std::llround(f.domain.size[c] / f.spacing) + outside;
    }
    for (std::int64_t k = first[2]; k < last[2]; ++k)
        for (std::int64_t j = first[1]; j < last[1]; ++j)
            for (std::int64_t i = first[0]; i < last[0]; ++i) {
                Vec3 x(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
                x = (x + Vec3::Constant(0.5)) * f.spacing;
                if (f.dimensions == 2) x[2] = 0.0;
                visit(x);
            }
}

void line_walls(SphFluid& f) {
    if (f.walls.empty()) return;
    const double deep = f.clusters.reach + f.clusters.skin;
    for_each_cell(f, static_cast<std::int64_t>(std::ceil(deep / f.spacing)) + 1, [&](const Vec3& x) {
        const std::vector<Behind> behind = walls_before(f.walls, x);
        if (behind.empty()) return;
        Vec3 to_surface = Vec3::Zero();
        for (const Behind& b : behind) to_surface += b.depth * b.normal;
        if (to_surface.norm() < deep) append_boundary_particle(f.boundary, f.dimensions, wall_particle(f, x, behind));
    });
}

} // namespace plumb
