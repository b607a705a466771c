// Instantiates the sweep for every pair of a contact and a rolling law, for dry grains.
#include "dem/contact_sweep.hpp"

namespace plumb {

void evaluate_pairs(Neighbours& list, const ContactModel& model, const Domain& domain, double dt) {
    if (const auto* bridges = liquid_bridges(model)) return evaluate_wet_pairs(list, model, *bridges, domain, dt);
    const auto& dry = std::get<PairLaws<NoCohesion>>(model.cohesion);
    std::visit(
        [&](const auto& contact, const auto& rolling) {
            using Law = typename std::decay_t<decltype(contact.laws)>::value_type;
            if constexpr (!std::is_same_v<Law, NoContact>) sweep_pairs(list, contact, rolling, dry, domain, dt);
        },
        model.contact, model.rolling);
}

} // namespace plumb
