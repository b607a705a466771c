// Walls: shapes that know where a sphere touches them.
//
// A wall is a law of the family Wall: it has `name`, `info`, a constructor from its table, and
//     template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const;
// which calls visit(WallPoint) for every separate contact point nearer to the centre x than `reach`.
// Walls have no periodic images: one that crosses a periodic side must itself reach from side to side.
#pragma once

#include "core/cylinder_rows.hpp"
#include "core/laws.hpp"
#include "core/triangle_mesh.hpp"
#include "core/vec.hpp"
#include "core/wall_point.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace plumb {

/// The half space on the side of `normal`.
struct Plane {
    static constexpr std::string_view name = "plane";
    static constexpr LawInfo info{"distance = (x - point) . normal", "any centre; negative behind the plane", "-"};
    explicit Plane(Table& table);
    Vec3 point;  // [m]
    Vec3 normal; // unit vector into the domain

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const double distance = normal.dot(x - point);
        if (distance < reach) visit(WallPoint{normal, distance, 0});
    }
};

/// The half space on the side of `normal` and a round bore through what is behind it: a floor with an inlet. The rim is
/// sharp.
struct BoredPlane {
    static constexpr std::string_view name = "bored_plane";
    static constexpr LawInfo info{"distance to the nearest point of plane, rim or bore, negative in the solid",
                                  "any centre", "-"};
    explicit BoredPlane(Table& table);
    Vec3 point;    // where the axis of the bore meets the plane [m]
    Vec3 normal;   // unit vector into the domain, along the axis
    Vec3 sideways; // a unit vector across it, where no other is defined
    double radius; // of the bore [m]

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const double height = normal.dot(x - point);
        const Vec3 across = x - point - height * normal;
        const double r = across.norm(), outside = r - radius;
        const Vec3 outward = r > 0.0 ? Vec3(across / r) : sideways;
        const bool over_plane = outside >= 0.0 && (height >= 0.0 || -height < outside);
        WallPoint nearest{normal, height, 0};
        if (!over_plane && height < 0.0) nearest = {-outward, -outside, 0};
        if (!over_plane && height >= 0.0) {
            const double to_rim = std::hypot(outside, height);
            nearest = {(height * normal + outside * outward) / to_rim, to_rim, 0};
        }
        if (nearest.distance < reach) visit(nearest);
    }
};

/// The inside of an axis-aligned box. Elements 0 to 5 are the faces at lower x, upper x, lower y, ... upper z.
struct Box {
    static constexpr std::string_view name = "box";
    static constexpr LawInfo info{"distance = x_c - lower_c or upper_c - x_c, c = x, y, z", "centres inside the box",
                                  "-"};
    explicit Box(Table& table);
    Vec3 lower, upper; // [m]

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        for (Eigen::Index c = 0; c < 3; ++c) {
            const auto element = static_cast<std::int32_t>(2 * c);
            if (x[c] - lower[c] < reach) visit(WallPoint{Vec3::Unit(c), x[c] - lower[c], element});
            if (upper[c] - x[c] < reach) visit(WallPoint{-Vec3::Unit(c), upper[c] - x[c], element + 1});
        }
    }
};

/// The inside or the outside of a circular cylinder, infinite along its axis (close it with planes).
struct Cylinder {
    static constexpr std::string_view name = "cylinder";
    static constexpr LawInfo info{"distance = radius - r (inside) or r - radius (outside), r = distance to the axis",
                                  "inside: grains thinner than the cylinder", "-"};
    explicit Cylinder(Table& table);
    Vec3 point;    // on the axis [m]
    Vec3 axis;     // unit vector
    Vec3 sideways; // a unit vector across the axis, the normal for a centre on the axis, where no other is defined
    double radius; // [m]
    double sign;   // -1 for grains inside, +1 outside

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const Vec3 from_point = x - point;
        const Vec3 across = from_point - axis * axis.dot(from_point);
        const double r = across.norm();
        const double distance = sign * (r - radius);
        if (!(distance < reach)) return;
        const Vec3 outward = r > 0.0 ? Vec3(across / r) : sideways;
        visit(WallPoint{sign * outward, distance, 0});
    }
};

/// The inside or the outside of a sphere (in two dimensions, of a circle).
struct SphereWall {
    static constexpr std::string_view name = "sphere";
    static constexpr LawInfo info{"distance = radius - r (inside) or r - radius (outside), r = distance to the centre",
                                  "inside: grains smaller than the sphere", "-"};
    explicit SphereWall(Table& table);
    Vec3 centre;   // [m]
    double radius; // [m]
    double sign;   // -1 for grains inside, +1 outside

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const Vec3 from_centre = x - centre;
        const double r = from_centre.norm(), distance = sign * (r - radius);
        if (!(distance < reach)) return;
        const Vec3 outward = r > 0.0 ? Vec3(from_centre / r) : Vec3(Vec3::UnitX()); // at the centre no other is defined
        visit(WallPoint{sign * outward, distance, 0});
    }
};

/// The outside of an axis-aligned box, whose edges and corners are sharp: one contact at a time.
struct SolidBox {
    static constexpr std::string_view name = "solid_box";
    static constexpr LawInfo info{"distance to the nearest point of the box, negative inside", "any centre", "-"};
    explicit SolidBox(Table& table);
    Vec3 lower, upper; // [m]

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const Vec3 away = x - x.cwiseMax(lower).cwiseMin(upper);
        const double outside = away.norm();
        if (outside > 0.0) {
            if (outside < reach) visit(WallPoint{away / outside, outside, 0});
            return;
        }
        Eigen::Index below = 0, above = 0; // the axes of the nearest faces
        const double to_lower = (x - lower).minCoeff(&below), to_upper = (upper - x).minCoeff(&above);
        if (to_lower < to_upper)
            visit(WallPoint{-Vec3::Unit(below), -to_lower, 0});
        else
            visit(WallPoint{Vec3::Unit(above), -to_upper, 0});
    }
};

using Wall = std::variant<Plane, BoredPlane, Box, SolidBox, Cylinder, SphereWall, CylinderRows, TriangleMesh>;

/// One wall of the scene. It moves without turning: at time t it is displaced by velocity * t.
struct WallBody {
    std::string name;
    Wall shape;
    Vec3 velocity = Vec3::Zero(); // [m/s]
    std::int32_t material = -1;   // index into the contact materials; set by the reader of contacts

    /// Contact points of the sphere at x [m] with this wall at `time` [s].
    template <class Visit> void touch(const Vec3& x, double reach, double time, Visit&& visit) const {
        const Vec3 seen = x - velocity * time;
        std::visit([&](const auto& s) { s.touch(seen, reach, visit); }, shape);
    }
};

/// The walls of all [[wall]] tables: `name`, `shape` with its keys, `velocity` (at rest when absent). In two
/// dimensions places have two numbers and a cylinder stands across the plane. `contact` and `slip` are left to their
/// readers. InputError for a name used twice and as the shapes say.
std::vector<WallBody> make_walls(std::vector<Table>& tables, int dimensions = 3);

/// Those of the [[wall]] tables that hold this, "fluid" or "grains": all but those that say they hold the other.
std::vector<Table> walls_that_hold(const std::vector<Table>& tables, std::string_view what);

} // namespace plumb
