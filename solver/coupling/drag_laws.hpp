// The family of drag laws and the functions that use it. The laws stand, by kind, in drag_laws_sphere.hpp (one sphere)
// and drag_laws_dense.hpp (suspensions and beds); each file ends with the list of its laws, so adding one touches that
// file.
#pragma once

#include "coupling/drag_laws_dense.hpp"
#include "coupling/drag_laws_sphere.hpp"
#include "coupling/drag_range.hpp"
#ifdef PLUMB_PLANTED
#include "coupling/planted_drag_laws.hpp"
#endif

#include <numbers>
#include <variant>

namespace plumb {

#ifdef PLUMB_PLANTED
using DragLaw = JoinedFamilies<SphereDragLaws, DenseDragLaws, PlantedDragLaws>;
#else
using DragLaw = JoinedFamilies<SphereDragLaws, DenseDragLaws>;
#endif

/// F = f_d / (3 pi mu d u_s) of `law` at re_superficial = rho d u_s/mu >= 0, u_s = eps |u - v|, 0 < eps <= 1.
inline double drag_ratio(const DragLaw& law, double re_superficial, double eps) {
    return std::visit([=](const auto& one) { return one(re_superficial, eps); }, law);
}

/// The range in which the source of `law` says it holds.
inline const DragRange& drag_range(const DragLaw& law) {
    return std::visit([](const auto& one) -> const DragRange& { return one.range; }, law);
}

/// Drag per interstitial slip, 3 pi mu d eps F [kg/s], of a grain of diameter d [m] slipping at |u - v| = `slip` [m/s]
/// through fluid of `density` [kg/m3] and `viscosity` [Pa s]: f_d = drag_resistance (u - v).
inline double drag_resistance(const DragLaw& law, double density, double viscosity, double diameter, double eps,
                              double slip) {
    const double re_superficial = density * diameter * eps * slip / viscosity;
    return 3.0 * std::numbers::pi * viscosity * diameter * eps * drag_ratio(law, re_superficial, eps);
}

} // namespace plumb
