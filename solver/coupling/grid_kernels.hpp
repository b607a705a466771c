// How a grain is spread over the nodes of a grid: w(q) of the distance in units of a width. Only the shape counts,
// since the weights of every grain are made to sum to one over the open nodes in reach. In a fluid of two dimensions it
// is the distance in the plane.
#pragma once

#include "core/laws.hpp"
#include "coupling/drag_range.hpp"
#include "sph/kernels.hpp"

#include <cmath>
#include <variant>

namespace plumb {

/// w = exp(-q^2/2): the width is the standard deviation along each axis.
struct GaussianKernel {
    static constexpr std::string_view name = "gaussian";
    static constexpr LawInfo info{"w = exp(-q^2/2), q < 3.5", "any width",
                                  "Apte, Mahesh & Lundgren 2008, Int. J. Multiphase Flow 34, 260"};
    static constexpr double support = 3.5; // beyond it lie .2 % of a grain in the plane, .7 % in space
    static double w(double q) { return std::exp(-0.5 * q * q); }
};

/// All of a grain in the cell that holds its centre, and in equal parts on the faces of it. It is here to show what
/// kernels avoid.
struct CellCounting {
    static constexpr std::string_view name = "cell_counting";
    static constexpr LawInfo info{"the cell of the centre", "cells several times as wide as a grain",
                                  "Crowe, Sharma & Stock 1977, J. Fluids Eng. 99, 325"};
};

using GridKernel = JoinedFamilies<std::variant<GaussianKernel, CellCounting>, Kernel>;

/// Beyond which a grain gives nothing, in widths; 0 where the width says nothing.
inline double reach_in_widths(const GridKernel& kernel) {
    return std::visit(
        [](const auto& law) {
            if constexpr (requires { law.support; })
                return law.support;
            else
                return 0.0;
        },
        kernel);
}

} // namespace plumb
