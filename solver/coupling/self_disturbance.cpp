#include "coupling/self_disturbance.hpp"

#include "core/packed_field.hpp"
#include "core/parallel.hpp"
#include "coupling/grid_symbols.hpp"
#include "sph/symbols.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

namespace {

// In units of the wider filter's h: what lies below the first wave is lumped into it, beyond the last one the filters'
// product is below 1e-6.
constexpr double first_wave = 0.03, last_wave = 12.0;

// Gauss' rule of eight points for -1 to 1 (Abramowitz & Stegun 1964, table 25.4); cosines() moves it to 0 to 1.
constexpr std::array<double, 4> gauss_node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
constexpr std::array<double, 4> gauss_weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                             0.1012285362903763};

struct Cosines {
    Pack c{}, weight{};
};
Cosines cosines() {
    Cosines rule;
    for (int i = 0; i < 4; ++i) {
        const auto q = static_cast<std::size_t>(i);
        rule.c[i] = 0.5 * (1.0 + gauss_node[q]), rule.c[i + 4] = 0.5 * (1.0 - gauss_node[q]);
        rule.weight[i] = rule.weight[i + 4] = 0.5 * gauss_weight[q];
    }
    return rule;
}

const Cosines rule = cosines();

double total(const Pack& p) {
    double sum = 0.0;
    for (int lane = 0; lane < pack_width; ++lane) sum += p[lane];
    return sum;
}

// Memory of a grain: of every wave number the three components of Re A, then of Im A, each for eight cosines [N s]; the
// backflow B of every wave number [m/s]; the last force on the fluid [N] and the last slip [m/s].
constexpr std::size_t waves_size = wave_numbers * 6 * pack_width, backflow_size = wave_numbers * 3;
constexpr std::size_t memory_size = waves_size + backflow_size + 6;

template <class Value> struct Memory {
    Value* waves;
    Value* backflow;
    Value* force;
    Value* slip;
    Value* wave(std::size_t n, std::size_t part) const { return waves + (6 * n + part) * pack_width; }
};
template <class Value> Memory<Value> memory_at(Value* start) {
    return {start, start + waves_size, start + waves_size + backflow_size, start + waves_size + backflow_size + 3};
}

/// Complex numbers, eight at once.
struct Complex {
    Pack re, im;
    friend Complex operator*(const Complex& a, const Complex& b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
};

/// (1 - i q)/(1 + i q): a turn by -2 arctan q, that is -2 q (1 - q^2/3), without an exponential.
Complex turn(const Pack& q) {
    const Pack one = broadcast<Pack>(1.0), square = q * q, inverse = one / (one + square);
    return {(one - square) * inverse, broadcast<Pack>(-2.0) * q * inverse};
}

/// What is kept of a wave that fades at a rate [1/s], and what a constant push leaves in it [s], over a step.
struct Fading {
    double kept, received;
};
Fading fading(double rate, double dt) {
    return {std::exp(-rate * dt), rate > 0.0 ? -std::expm1(-rate * dt) / rate : dt};
}

/// One step of one wave number: A' = exp(-i k.w dt - r dt) A + exp(-i k.w dt/2) F Int exp(-r t) dt.
void carry(const Memory<double>& m, std::size_t n, const Vec3& force, const Pack& phase, const Fading& step) {
    const Complex half = turn(broadcast<Pack>(0.25) * phase), whole = half * half;
    for (std::size_t c = 0; c < 3; ++c) {
        const Pack push = broadcast<Pack>(step.received * force[static_cast<Eigen::Index>(c)]);
        const Complex old{load(m.wave(n, c)), load(m.wave(n, 3 + c))};
        const Complex past = whole * old;
        store(m.wave(n, c), broadcast<Pack>(step.kept) * past.re + push * half.re);
        store(m.wave(n, 3 + c), broadcast<Pack>(step.kept) * past.im + push * half.im);
    }
}

/// A = F/(r + i k.w), where a constant push would bring it in the end.
void settle(const Memory<double>& m, std::size_t n, const Vec3& force, const Pack& frequency, double rate) {
    const Pack r = broadcast<Pack>(rate), inverse = broadcast<Pack>(1.0) / (r * r + frequency * frequency);
    for (std::size_t c = 0; c < 3; ++c) {
        const Pack push = broadcast<Pack>(force[static_cast<Eigen::Index>(c)]);
        store(m.wave(n, c), push * r * inverse);
        store(m.wave(n, 3 + c), -(push * frequency * inverse));
    }
}

} // namespace

OseenBrinkman::OseenBrinkman(Table& t)
    : steady(t.choice("history", {"unsteady", "steady"}) == "steady"),
      advected(t.choice("advection", {"slip", "none"}) == "slip"),
      structure(make_family<StructureFactor>(t.law("structure"))) {}

namespace {

/// What a scheme makes of waves of one number.
struct WaveSymbols {
    double spread, gather, room; // filters of the push, of what is gathered, and of the porosity
    double inside;               // share of the directions in which there are such waves
    double decay;                // [1/s]
    double backflow;             // of the fluid that makes room, over the exact one
    double settles;              // [1/s]
};

/// The sums over wave numbers, in units of the wider filter.
template <class SymbolsAt>
SelfDisturbance over_waves(const OseenBrinkman& law, double wider, double d, SymbolsAt&& at) {
    SelfDisturbance self{law, 0.0, {}, {}, {}, {}, {}, 0.0, 0.0, 0.0, {}, {}};
    self.fraction = std::visit([](const auto& s) { return s.fraction; }, law.structure);
    const double ratio = std::log(last_wave / first_wave) / (wave_numbers - 1.0);
    for (std::size_t n = 0; n < wave_numbers; ++n) {
        const double k = first_wave / wider * std::exp(ratio * static_cast<double>(n));
        // dk of the trapezium; the integrand of a steady wake is constant below the first wave
        const double width = k * ratio + (n == 0 ? k * std::exp(-0.5 * ratio) : 0.0);
        const double s_of_k = std::visit([&](const auto& s) { return s(k, d); }, law.structure);
        const WaveSymbols symbols = at(k);
        const double measure =
            k * k * width / (2.0 * std::numbers::pi * std::numbers::pi) * symbols.gather * s_of_k * symbols.inside;
        const double p = measure * symbols.room;
        self.k[n] = k;
        self.decay[n] = symbols.decay;
        self.share[n] = measure * symbols.spread;
        self.backflow[n] = p * symbols.backflow / 3.0;
        self.settles[n] = symbols.settles;
        self.own_spread += self.share[n];
        self.own_porosity += p;
    }
    return self;
}

} // namespace

SelfDisturbance self_disturbance(const OseenBrinkman& law, const SphFluid& f, const Kernel& kernel,
                                 const CouplingWidths& h, const PorosityLaw& porosity, double d) {
    SelfDisturbance self = over_waves(law, std::max(h.spread, h.gather), d, [&](double k) {
        const double own = kernel_transform(f.kernel, k * f.h), decay = transverse_decay(f, k);
        return WaveSymbols{kernel_transform(kernel, k * h.spread),
                           kernel_transform(kernel, k * h.gather),
                           transform(porosity, kernel_transform(kernel, k * h.porosity), k, d),
                           1.0,
                           decay,
                           own > 0.0 ? 1.0 / own : 0.0,
                           f.sound_speed * f.sound_speed * k * k * own * own / std::max(decay, 1e-300)};
    });
    self.density = f.density;
    return self;
}

SelfDisturbance self_disturbance(const OseenBrinkman& law, const GridSymbols& grid, double d) {
    // Smoothed particles' kernels deviate by about half their h, so this is the unit that serves them.
    const double unit = 2.0 * deviation_in_widths(grid.kernel) * grid.width;
    SelfDisturbance self = over_waves(law, unit, d, [&](double k) {
        const double filter = kernel_transform(grid.kernel, k * grid.width);
        const GridShell shell = grid_shell(k, grid.cell);
        return WaveSymbols{filter,
                           filter,
                           filter,
                           shell.inside,
                           grid.viscosity / grid.density * shell.square,
                           1.0,
                           std::numeric_limits<double>::infinity()};
    });
    self.density = grid.density * (1.0 - self.fraction); // a push moves what the other grains leave of the room
    return self;
}

std::size_t wake_size() { return memory_size; }
std::size_t waves_before_size() { return waves_size; }

OwnFluid own_fluid(const SelfDisturbance& self, std::size_t id, double volume) {
    const auto m = memory_at(self.memory.data() + id * memory_size);
    const Pack weighted = rule.weight * rule.c * rule.c;
    const Vec3 slip(m.slip[0], m.slip[1], m.slip[2]);
    const double speed = slip.norm();
    const Vec3 along = speed > 0.0 ? Vec3(slip / speed) : Vec3::Zero();
    OwnFluid own{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t n = 0; n < wave_numbers; ++n) {
        Vec3 mean, weighted_mean; // of Re A over the cosines, plain and with c^2
        Vec3 back;
        for (std::size_t c = 0; c < 3; ++c) {
            const Pack a = load(m.wave(n, c));
            const auto axis = static_cast<Eigen::Index>(c);
            mean[axis] = total(rule.weight * a), weighted_mean[axis] = total(weighted * a);
            back[axis] = m.backflow[3 * n + c];
        }
        // (I - kk/k^2) averaged about the slip: 1 - c^2 along it, (1 + c^2)/2 across
        const Vec3 across = 0.5 * (mean + weighted_mean);
        const Vec3 transverse = self.share[n] * (across + 0.5 * along.dot(mean - 3.0 * weighted_mean) * along);
        own.u += transverse / self.density - (volume * self.backflow[n]) * back;
        own.stress -= self.decay[n] * transverse;
    }
    own.stress -= (self.own_spread / 3.0) * Vec3(m.force[0], m.force[1], m.force[2]);
    return own;
}

void take_out(const SelfDisturbance& self, const std::vector<double>& mass, const std::vector<double>& volume,
              GatheredFluid& at) {
    parallel_for(mass.size(), [&](std::size_t id) {
        const OwnFluid own = own_fluid(self, id, volume[id]);
        at.u[id] -= own.u;
        at.stress[id] -= own.stress;
        at.a[id] -= own.stress / self.density;
        at.load[id] = std::max(0.0, at.load[id] - mass[id] * self.own_spread / (self.density * at.eps[id]));
        at.eps[id] = std::min(1.0, at.eps[id] + volume[id] * self.own_porosity);
    });
}

void remember(SelfDisturbance& self, const std::vector<Push>& pushes, double dt) {
    std::array<Fading, wave_numbers> unscreened{}; // the same for all grains that settle
    std::array<double, wave_numbers> taken{};
    for (std::size_t n = 0; n < wave_numbers; ++n) {
        unscreened[n] = fading(self.decay[n], dt);
        taken[n] = -std::expm1(-self.settles[n] * dt);
    }
    parallel_for(pushes.size(), [&](std::size_t id) {
        const auto m = memory_at(self.memory.data() + id * memory_size);
        const Push& push = pushes[id];
        const double speed = self.law.advected ? push.slip.norm() : 0.0;
        for (std::size_t n = 0; n < wave_numbers; ++n) {
            const double rate = self.decay[n] + push.screening;
            const Pack frequency = broadcast<Pack>(self.k[n] * speed) * rule.c;
            if (self.law.steady)
                settle(m, n, push.force, frequency, rate);
            else
                carry(m, n, push.force, frequency * broadcast<Pack>(dt),
                      push.screening == 0.0 ? unscreened[n] : fading(rate, dt));
            for (std::size_t c = 0; c < 3; ++c) {
                const double target = -push.slip[static_cast<Eigen::Index>(c)];
                double& back = m.backflow[3 * n + c];
                back += taken[n] * (target - back);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            m.force[c] = push.force[static_cast<Eigen::Index>(c)];
            m.slip[c] = push.slip[static_cast<Eigen::Index>(c)];
        }
    });
}

namespace {

/// exp(-i angle).
Complex turned_back(const Pack& angle) {
    Complex turn{};
    for (int lane = 0; lane < pack_width; ++lane)
        turn.re[lane] = std::cos(angle[lane]), turn.im[lane] = -std::sin(angle[lane]);
    return turn;
}

/// Calls visit(id, memory) for all grains.
template <class Visit> void for_all_wakes(SelfDisturbance& self, Visit&& visit) {
    parallel_for(self.memory.size() / memory_size,
                 [&](std::size_t id) { visit(id, memory_at(self.memory.data() + id * memory_size)); });
}

/// A = F/(r + i k.w) of all waves of a grain with its last slip.
void settle_all(const SelfDisturbance& self, const Memory<double>& m, const Vec3& force, double screening) {
    const double speed = self.law.advected ? Vec3(m.slip[0], m.slip[1], m.slip[2]).norm() : 0.0;
    for (std::size_t n = 0; n < wave_numbers; ++n)
        settle(m, n, force, broadcast<Pack>(self.k[n] * speed) * rule.c, self.decay[n] + screening);
}

} // namespace

void turn_wakes(SelfDisturbance& self, double dt) {
    for_all_wakes(self, [&](std::size_t id, const Memory<double>& m) {
        for (std::size_t k = 0; k < backflow_size; ++k) m.backflow[k] = -m.slip[k % 3]; // it is there at once
        const double speed = self.law.advected ? Vec3(m.slip[0], m.slip[1], m.slip[2]).norm() : 0.0;
        if (self.law.steady || speed == 0.0) return;
        Memory<double> before = m;
        before.waves = self.before.data() + id * waves_size;
        for (std::size_t n = 0; n < wave_numbers; ++n) {
            const Complex turn = turned_back(broadcast<Pack>(self.k[n] * speed * dt) * rule.c);
            for (const Memory<double>& of : {m, before})
                for (std::size_t c = 0; c < 3; ++c) {
                    const Complex wave = turn * Complex{load(of.wave(n, c)), load(of.wave(n, 3 + c))};
                    store(of.wave(n, c), wave.re);
                    store(of.wave(n, 3 + c), wave.im);
                }
        }
    });
}

std::vector<double> fade_wakes(SelfDisturbance& self, const std::vector<Push>& pushes, const WakeStep& step) {
    std::vector<double> response(pushes.size(), 0.0);
    const double of_last = (step.two_steps ? 2.0 : 1.0) / step.dt, of_before = (step.two_steps ? -0.5 : 0.0) / step.dt;
    for_all_wakes(self, [&](std::size_t id, const Memory<double>& m) {
        if (self.law.steady) {
            const Vec3 slip(m.slip[0], m.slip[1], m.slip[2]);
            const Vec3 along = slip.norm() > 0.0 ? Vec3(slip.normalized()) : Vec3::UnitZ();
            settle_all(self, m, along, pushes[id].screening);
            response[id] = own_fluid(self, id, 0.0).u.dot(along);
            std::fill_n(m.waves, waves_size, 0.0);
            return;
        }
        double* before = self.before.data() + id * waves_size;
        for (std::size_t n = 0; n < wave_numbers; ++n) {
            const double left = 1.0 / (step.per_time() + self.decay[n] + pushes[id].screening);
            for (std::size_t k = 6 * n * pack_width; k < 6 * (n + 1) * pack_width; ++k) {
                const double last = m.waves[k];
                m.waves[k] = left * (of_last * last + of_before * before[k]);
                before[k] = last;
            }
            response[id] += 2.0 / 3.0 * self.share[n] * left / self.density; // the mean of 1 - c^2
        }
    });
    return response;
}

void push_wakes(SelfDisturbance& self, const std::vector<Push>& pushes, const WakeStep& step) {
    for_all_wakes(self, [&](std::size_t id, const Memory<double>& m) {
        const Push& push = pushes[id];
        for (std::size_t c = 0; c < 3; ++c) m.force[c] = push.force[static_cast<Eigen::Index>(c)];
        if (self.law.steady) return settle_all(self, m, push.force, push.screening);
        for (std::size_t n = 0; n < wave_numbers; ++n) {
            const double received = 1.0 / (step.per_time() + self.decay[n] + push.screening);
            for (std::size_t c = 0; c < 3; ++c)
                store(m.wave(n, c),
                      load(m.wave(n, c)) + broadcast<Pack>(received * push.force[static_cast<Eigen::Index>(c)]));
        }
    });
}

void set_slips(SelfDisturbance& self, const std::vector<Push>& pushes) {
    for_all_wakes(self, [&](std::size_t id, const Memory<double>& m) {
        for (std::size_t c = 0; c < 3; ++c) m.slip[c] = pushes[id].slip[static_cast<Eigen::Index>(c)];
    });
}

} // namespace plumb
