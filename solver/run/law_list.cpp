#include "run/law_list.hpp"

#include "core/initial_fields.hpp"
#include "coupling/self_disturbance.hpp"
#include "coupling/suspension_viscosity.hpp"
#include "coupling/wetting_laws.hpp"
#include "dem/arrange.hpp"
#include "run/probes.hpp"
#include "sph/arrange_fluid.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumb {

std::vector<LawFamily> law_families() {
    std::vector<LawFamily> families{{"fluid.flow", law_entries<PrescribedFlow>()},
                                    {"fluid.kernel", law_entries<Kernel>()},
                                    {"fluid.equation_of_state", law_entries<EquationOfState>()},
                                    {"fluid.operators", law_entries<Operators>()},
                                    {"fluid.viscous_term", law_entries<ViscousTerm>()},
                                    {"fluid.source", law_entries<Source>()},
                                    {"fluid.surface", law_entries<SurfaceLaw>()},
                                    {"fluid.initial", law_entries<InitialField>()},
                                    {"fluid.advection (grid)", law_entries<Advection>()},
                                    {"fluid.porosity (grid)", law_entries<MediumPorosity>()},
                                    {"fluid.resistance (grid)", law_entries<Resistance>()},
                                    {"fluid.source (grid)", law_entries<GridSource>()},
                                    {"fluid.fill", law_entries<Fill>()},
                                    {"grains.diameter", law_entries<DiameterLaw>()},
                                    {"grains.velocity", law_entries<VelocityLaw>()},
                                    {"grains.arrange", law_entries<Arrangement>()},
                                    {"grains.contact", law_entries<ContactLaw>()},
                                    {"grains.contact.rolling", law_entries<RollingLaw>()},
                                    {"grains.contact.cohesion", law_entries<CohesionLaw>()},
                                    {"wall.shape", law_entries<Wall>()},
                                    {"coupling.kernel (grid)", law_entries<GridKernel>()},
                                    {"coupling.drag", law_entries<DragLaw>()},
                                    {"coupling.forces", law_entries<OtherForce>()},
                                    {"coupling.basset", law_entries<HistoryForce>()},
                                    {"coupling.exchange", law_entries<Exchange>()},
                                    {"coupling.porosity", law_entries<PrescribedPorosity>()},
                                    {"coupling.porosity (sph)", law_entries<PorosityLaw>()},
                                    {"coupling.suspension_viscosity", law_entries<SuspensionViscosity>()},
                                    {"coupling.wetting", law_entries<WettingLaw>()},
                                    {"coupling.self_disturbance", law_entries<SelfDisturbanceLaw>()},
                                    {"coupling.self_disturbance.structure", law_entries<StructureFactor>()},
                                    {"probe.quantity", law_entries<ProbeQuantity>()}};
    return families;
}

std::string law_list(bool json) {
    if (json) {
        nlohmann::ordered_json all;
        for (const LawFamily& family : law_families())
            for (const LawEntry& law : family.laws)
                all[family.name].push_back({{"name", law.name},
                                            {"formula", law.info.formula},
                                            {"range", law.info.range},
                                            {"source", law.info.source}});
        return all.dump(2) + "\n";
    }
    std::string text;
    for (const LawFamily& family : law_families()) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", family.name);
        for (const LawEntry& law : family.laws)
            text += fmt::format("  {}\n      {}\n      range: {}\n      source: {}\n", law.name, law.info.formula,
                                law.info.range, law.info.source);
    }
    return text;
}

} // namespace plumb
