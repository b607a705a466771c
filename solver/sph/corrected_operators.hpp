// Which gradients the equations of motion are made of.
#pragma once

#include "core/field.hpp"
#include "core/laws.hpp"

#include <array>
#include <cstdint>
#include <variant>

namespace plumb {

/// Sums with the gradient of the kernel as it is, pressure in the form that conserves momentum (pair_terms.hpp). A
/// linear field has the right gradient only as far as the neighbours are those of an integral.
struct PlainOperators {
    static constexpr std::string_view name = "plain";
    static constexpr LawInfo info{"-sum m (p_a/rho_a^2 + p_b/rho_b^2) grad W, sum m v_ab . grad W",
                                  "any; conserves momentum; errors of fixed h/spacing do not vanish",
                                  "Monaghan 2005, Rep. Prog. Phys. 68, 1703"};
};

/// Plain sums that weigh a neighbour by its room V = m/rho and not by its mass: where rooms differ from neighbour to
/// neighbour, as those of particles of pure fluid do from those that began among grains, the sums of masses count each
/// as large as a itself. Pairs still exchange momentum, and -p dV of the one is the work of the other.
struct VolumeWeightedOperators {
    static constexpr std::string_view name = "volume_weighted";
    static constexpr LawInfo info{"-1/m_a sum V_a V_b (p_a + p_b) grad W, rho_a sum V_b v_ab . grad W",
                                  "any; conserves momentum; the room of all particles is not that of the fluid after "
                                  "long flows (fluid.filling_time)",
                                  "Colagrossi & Landrini 2003, J. Comput. Phys. 191, 448, sec. 3"};
};

/// Sums of differences with B_a grad W, B_a^-1 = sum V_b (x_b - x_a) (x) grad_a W: exact for linear fields whatever the
/// neighbours, at the price of momentum, which is conserved to the order of the scheme only.
struct CorrectedOperators {
    static constexpr std::string_view name = "corrected";
    static constexpr LawInfo info{"-1/rho_a sum V (p_b - p_a) B_a grad W, -rho_a sum V (v_b - v_a) . B_a grad W",
                                  "any; second order where particles are evenly spread over h; loses momentum",
                                  "Bonet & Lok 1999, Comput. Methods Appl. Mech. Eng. 180, 97; Negi & Ramachandran "
                                  "2022, arXiv 2107.11859"};
};

/// Plain sums with a smoothing length of each particle's own, h (rho_0/rho)^(1/d) (variable_sweep.hpp). Among grains
/// rho is the superficial density, so h follows the room that a particle takes: h eps^(-1/d).
struct VariableOperators {
    static constexpr std::string_view name = "variable_h";
    static constexpr LawInfo info{"-sum m [p_a/(Omega_a rho_a^2) grad W(h_a) + p_b/(Omega_b rho_b^2) grad W(h_b)], "
                                  "1/Omega_a sum m v_ab . grad W(h_a)",
                                  "rho from rho_0/greatest_growth^d on; conserves momentum and energy",
                                  "Springel & Hernquist 2002, Mon. Not. R. Astron. Soc. 333, 649"};
    double greatest_growth = 1.05; // of h over that at rho_0: the lists reach that far
    VariableOperators() = default;
    explicit VariableOperators(Table& table)
        : greatest_growth(table.number_or("greatest_growth", 1.05, {1.0, 2.0, false, false})) {}
};

using Operators = std::variant<PlainOperators, VolumeWeightedOperators, CorrectedOperators, VariableOperators>;

/// How much longer than h a smoothing length may get.
inline double greatest_growth(const Operators& operators) {
    const auto* variable = std::get_if<VariableOperators>(&operators);
    return variable != nullptr ? variable->greatest_growth : 1.0;
}

/// Smoothing length of a record, as pairs need it.
struct RecordLength {
    double inverse_h;         // [1/m]
    double factor;            // sigma/h^(d+2)
    double factor_over_omega; // the same over Omega of the last evaluation
};

/// Smoothing lengths where they vary; empty otherwise.
struct VariableLengths {
    Field<RecordLength> of_record;
    Field<double> omega;     // [slots]
    std::int64_t capped = 0; // lengths that would have grown further than greatest_growth, set to it
};

/// What the first pass of the corrected operators leaves for the second.
struct CorrectedFields {
    Field<double> gradients;               // [records][corrected_stride] rows of grad v [1/s], then grad rho [kg/m4]
    std::array<Field<double>, 6> inverses; // [slots] of the sums that make linear fields exact: xx yy xy (zz xz yz)
};

} // namespace plumb
