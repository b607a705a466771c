// Instantiates the sweep for every pair of a contact and a rolling law, with liquid bridges.
#include "dem/contact_sweep.hpp"

namespace plumb {

void evaluate_wet_pairs(Neighbours& list, const ContactModel& model, const PairLaws<LiquidBridge>& bridges,
                        const Domain& domain, double dt) {
    std::visit(
        [&](const auto& contact, const auto& rolling) {
            using Law = typename std::decay_t<decltype(contact.laws)>::value_type;
            if constexpr (!std::is_same_v<Law, NoContact>) sweep_pairs(list, contact, rolling, bridges, domain, dt);
        },
        model.contact, model.rolling);
}

} // namespace plumb
