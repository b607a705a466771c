// How much of a sphere lies in a box.
#pragma once

#include "core/vec.hpp"

namespace plumb {

/// Area of a disc of radius r [m] around the origin inside the rectangle [x0, x1] x [y0, y1]; exact [m2].
double disc_rectangle_overlap(double r, double x0, double x1, double y0, double y1);

/// Volume of a sphere of radius R [m] around the origin inside the box [lower, upper] [m3]; corners may be infinite.
/// Exact (spherical caps) when at most one axis cuts the sphere. Else the exact areas of slices are integrated by
/// Gauss's rule between all heights at which the shape of the slice changes; error below 1e-6 of the sphere.
double sphere_box_overlap(double radius, const Vec3& lower, const Vec3& upper);

} // namespace plumb
