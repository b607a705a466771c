// Open sides: planes through which the fluid comes in with a given profile, or leaves at a given pressure.
//
// Behind the plane is a buffer of boundary particles as deep as the kernel reaches. They move with their velocity; one
// that crosses an inlet becomes fluid and is replaced at the far end of the buffer, fluid that crosses an outlet
// becomes part of its buffer. An outlet lets out what comes; where a flow recirculates, even ones have to, or the fluid
// that would come back is lost (even_outlets.hpp). Sound leaves: the state in the buffer is a slow mean plus the part
// of the deviation from it that the outgoing characteristic carries (after Lastiwka, Basa & Quinlan 2009, Int. J.
// Numer. Meth. Fluids 61, 709).
#pragma once

#include "core/inlet_profiles.hpp"
#include "core/vec.hpp"

#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct SphFluid;

/// A plane across the flow, at rest.
struct OpenSide {
    std::string name;
    Vec3 point;                          // on the plane, on the axis of the flow [m]
    Vec3 normal;                         // unit vector into the fluid
    double averaging_time = 0.0;         // of the slow mean [s]
    std::optional<InletProfile> profile; // of an inlet
    bool even = false;                   // of an outlet: as fast everywhere, as through a sieve
    bool rigid = false;                  // of an inlet: a piston, whose speed no wave changes
    double flow_rate = 0.0;  // that the buffer's rows are to bring in together [m3/s]; 0: as the profile says
    double opens_from = 0.0; // of an inlet: closed before [s],
    double opens_over = 0.0; // open after so much more, linearly in between [s]
    double pressure = 0.0;   // of an outlet [Pa]

    double scale = 1.0;        // of the profile, for the flow rate
    double amount = 0.0;       // by the lattice: what an open inlet brings in [m3/s], how wide an outlet is [m2]
    double mean_outflow = 0.0; // of an even outlet at present, superficial [m/s]
    double opening = 1.0;      // share of the inflow that comes in at present

    bool is_inlet() const { return profile.has_value(); }
    /// Distance in front of the plane; negative in the buffer [m].
    double distance(const Vec3& x) const { return (x - point).dot(normal); }
    Vec3 reflected(const Vec3& x) const { return x - 2.0 * distance(x) * normal; }
    /// Speed into the domain that an inlet prescribes at x [m/s].
    double inflow(const Vec3& x, int dimensions) const {
        const Vec3 across = x - point - distance(x) * normal;
        return scale * opening * std::visit([&](const auto& law) { return law(across.norm(), dimensions); }, *profile);
    }
};

/// True behind any of the sides.
bool is_outside(const std::vector<OpenSide>& sides, const Vec3& x);

/// Fills the buffers on the lattice of the fluid, outside the walls, scales the profiles of inlets to their flow rates
/// and finds what each side amounts to. Returns the number of a side whose buffer has no place for a particle, or none.
std::optional<std::size_t> fill_buffers(SphFluid& fluid);

/// Sets how far the inlets are open at `time` [s], and what even outlets let out.
void set_openings(SphFluid& fluid, double time);

/// Particles that have crossed a plane change sides. Slots and boundary particles appear and vanish: the lists have to
/// be renewed.
void pass_open_sides(SphFluid& fluid);

} // namespace plumb
