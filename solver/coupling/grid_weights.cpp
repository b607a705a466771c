#include "coupling/grid_weights.hpp"

#include "core/parallel.hpp"
#include "grid/sums.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Number of the cell along an axis that holds x; on a periodic axis counted on beyond the box, else the nearest.
int cell_at(const Axis& axis, double x) {
    const double length = axis.node.back() - axis.node.front();
    const double turns = axis.periodic ? std::floor((x - axis.node.front()) / length) : 0.0;
    const auto above = std::upper_bound(axis.node.begin(), axis.node.end(), x - turns * length);
    const int k = static_cast<int>(above - axis.node.begin()) - 1;
    return static_cast<int>(turns) * axis.cells() + std::clamp(k, 0, axis.cells() - 1);
}

bool inside(const Axis& axis, double x) { return axis.periodic || (x >= axis.node.front() && x <= axis.node.back()); }

/// A place along an axis, how far a point is from it, and the kernel's factor for that where it is a product of such.
struct Near {
    int index;
    double away_sq; // [m2]
    double factor = 1.0;
};

/// The cells, or the faces, of an axis in reach of x.
void near_along(const Axis& axis, double x, double reach, bool of_faces, std::vector<Near>& found) {
    found.clear();
    const int n = axis.cells();
    const double length = axis.node.back() - axis.node.front();
    const int first = cell_at(axis, x - reach), last = cell_at(axis, x + reach) + (of_faces ? 1 : 0);
    for (int k = first; k <= last; ++k) {
        const int turns = axis.periodic ? static_cast<int>(std::floor(static_cast<double>(k) / n)) : 0;
        const int index = k - turns * n;
        const double at = (of_faces ? axis.node[static_cast<std::size_t>(index)] : axis.centre(index)) + turns * length;
        if (std::abs(at - x) < reach) found.push_back({index, (at - x) * (at - x)});
    }
}

/// Columns of P one after the other.
struct Columns {
    std::vector<std::size_t> size;
    std::vector<std::int32_t> node;
    std::vector<double> weight;

    void add(std::size_t at, double value) {
        node.push_back(static_cast<std::int32_t>(at));
        weight.push_back(value);
    }
    /// The entries from `first` on are a column; its weights are divided by their sum.
    void end(std::size_t first, double sum) {
        if (!(sum > 0.0)) {
            node.resize(first);
            weight.resize(first);
        }
        for (std::size_t k = first; k < weight.size(); ++k) weight[k] /= sum;
        size.push_back(weight.size() - first);
    }
};

/// What columns are made for.
struct Nodes {
    const GridFluid& fluid;
    Block block;
    const Field<double>& volume;
    int faces_across; // -1 for cells
    double width;     // of the kernel [m]
};

/// exp(-q^2/2) is a product over the axes: it takes one exponential a place along an axis, not one a node.
template <class Law> inline constexpr bool is_product = std::is_same_v<Law, GaussianKernel>;

/// Volume times kernel for the nodes of a block near x, divided by their sum.
template <class Law> void add_column(const Law& law, const Nodes& n, const Vec3& x, Columns& found) {
    static thread_local std::array<std::vector<Near>, 3> near; // keep their memory from grain to grain
    const double reach = law.support * n.width, reach_sq = reach * reach;
    for (std::size_t d = 0; d < 3; ++d) {
        near[d].assign(1, {0, 0.0});
        if (d >= n.fluid.dimensions()) continue;
        const bool of_faces = static_cast<int>(d) == n.faces_across;
        near_along(n.fluid.grid.axis[d], x[static_cast<Eigen::Index>(d)], reach, of_faces, near[d]);
        if constexpr (is_product<Law>)
            for (Near& place : near[d]) place.factor = law.w(std::sqrt(place.away_sq) / n.width);
    }
    const std::size_t first = found.weight.size();
    double sum = 0.0;
    for (const Near& z : near[2])
        for (const Near& y : near[1]) {
            const std::size_t row = n.block.at({0, y.index, z.index});
            for (const Near& along : near[0]) {
                const double away_sq = along.away_sq + y.away_sq + z.away_sq;
                const std::size_t node = row + static_cast<std::size_t>(along.index);
                if (away_sq >= reach_sq || n.volume[node] == 0.0) continue;
                const double w =
                    is_product<Law> ? along.factor * (y.factor * z.factor) : law.w(std::sqrt(away_sq) / n.width);
                found.add(node, n.volume[node] * w);
                sum += found.weight.back();
            }
        }
    found.end(first, sum);
}

/// The cell of the centre, or its two faces.
void add_column(const CellCounting& /*law*/, const Nodes& n, const Vec3& x, Columns& found) {
    Place p{0, 0, 0};
    bool outside = false;
    for (std::size_t d = 0; d < n.fluid.dimensions(); ++d) {
        const Axis& axis = n.fluid.grid.axis[d];
        outside = outside || !inside(axis, x[static_cast<Eigen::Index>(d)]);
        p[d] = ((cell_at(axis, x[static_cast<Eigen::Index>(d)]) % axis.cells()) + axis.cells()) % axis.cells();
    }
    const std::size_t first = found.weight.size();
    const auto add = [&](const Place& at) {
        if (!outside && n.volume[n.block.at(at)] > 0.0) found.add(n.block.at(at), 1.0);
    };
    add(p);
    if (n.faces_across >= 0) {
        const auto c = static_cast<std::size_t>(n.faces_across);
        p[c] = n.fluid.grid.axis[c].face_above(p[c]);
        add(p);
    }
    found.end(first, static_cast<double>(found.weight.size() - first));
}

SparseColumns joined(const std::vector<Columns>& parts) {
    SparseColumns all;
    std::vector<std::ptrdiff_t> first(parts.size()); // entry of each part
    for (std::size_t q = 0; q < parts.size(); ++q) {
        first[q] = static_cast<std::ptrdiff_t>(all.begin.back());
        for (const std::size_t size : parts[q].size) all.begin.push_back(all.begin.back() + size);
    }
    all.node.resize(all.begin.back());
    all.weight.resize(all.begin.back());
    const auto copy = [&](std::size_t q) {
        std::copy(parts[q].node.begin(), parts[q].node.end(), all.node.begin() + first[q]);
        std::copy(parts[q].weight.begin(), parts[q].weight.end(), all.weight.begin() + first[q]);
    };
    parallel_for(parts.size(), copy);
    return all;
}

/// Columns of all grains for cells (faces_across < 0) or the faces across an axis.
SparseColumns columns(const GridWeights& w, const GridFluid& f, const std::vector<Vec3>& x, int faces_across) {
    constexpr std::size_t share = 64; // grains that a thread takes at once
    const bool of_cells = faces_across < 0;
    const auto c = static_cast<std::size_t>(std::max(faces_across, 0));
    const Nodes nodes{f, of_cells ? f.grid.cells() : f.grid.faces(c), of_cells ? w.cell_volume : w.face_volume[c],
                      faces_across, w.width};
    std::vector<Columns> parts((x.size() + share - 1) / share);
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j)
            std::visit([&](const auto& law) { add_column(law, nodes, x[j], parts[begin / share]); }, w.kernel);
    };
    parallel_chunks(x.size(), run, share);
    return joined(parts);
}

/// The open cells beside a cell.
std::vector<std::size_t> neighbours(const GridFluid& f, const Place& p) {
    const Block cells = f.grid.cells();
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (const int way : {0, 1}) {
            Place q = p, face = p;
            q[c] = f.grid.axis[c].next(p[c], way);
            if (way == 1) face[c] = f.grid.axis[c].face_above(p[c]);
            if (q[c] >= 0 && f.open.face[c][f.grid.faces(c).at(face)] > 0.0) found.push_back(cells.at(q));
        }
    return found;
}

/// Takes solids out of cells that hold more than `most` of them, in equal parts to the neighbours. Returns how many
/// cells were too full at the start.
std::int64_t relieve(const GridFluid& f, const Field<double>& room, double most, Field<double>& solid, Relief& relief) {
    constexpr int most_passes = 1000;
    const Block cells = f.grid.cells();
    std::int64_t count = -1;
    for (int pass = 0; pass < most_passes; ++pass) {
        Relief step;
        std::vector<Relief::Move>& moves = step.passes.emplace_back();
        std::int64_t full = 0;
        for (std::size_t k = 0; k < solid.size(); ++k) {
            const double excess = solid[k] - most * room[k];
            if (room[k] == 0.0 || excess <= 1e-12 * room[k]) continue;
            ++full;
            std::vector<std::size_t> beside = neighbours(f, cells.place(k));
            if (!beside.empty()) moves.push_back({k, excess / solid[k], std::move(beside)});
        }
        if (count < 0) count = full;
        if (moves.empty()) break;
        step.spread(solid);
        relief.passes.push_back(std::move(moves));
    }
    return count;
}

} // namespace

bool is_open(const GridFluid& f, const Vec3& x) {
    Place p{0, 0, 0};
    for (std::size_t d = 0; d < f.dimensions(); ++d) {
        const Axis& axis = f.grid.axis[d];
        const double at = x[static_cast<Eigen::Index>(d)];
        if (!inside(axis, at)) return false;
        p[d] = ((cell_at(axis, at) % axis.cells()) + axis.cells()) % axis.cells();
    }
    return f.open.cell[f.grid.cells().at(p)] > 0.0;
}

void Relief::spread(Field<double>& amount) const {
    for (const std::vector<Move>& moves : passes) {
        std::vector<double> moved;
        moved.reserve(moves.size());
        for (const Move& m : moves) moved.push_back(m.share * amount[m.from]);
        for (std::size_t k = 0; k < moves.size(); ++k) {
            amount[moves[k].from] -= moved[k];
            for (const std::size_t to : moves[k].to) amount[to] += moved[k] / static_cast<double>(moves[k].to.size());
        }
    }
}

void Relief::gather(std::vector<Vec3>& field) const {
    for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass) {
        std::vector<Vec3> seen;
        seen.reserve(pass->size());
        for (const Move& m : *pass) {
            Vec3 mean = Vec3::Zero();
            for (const std::size_t to : m.to) mean += field[to] / static_cast<double>(m.to.size());
            seen.emplace_back((1.0 - m.share) * field[m.from] + m.share * mean);
        }
        for (std::size_t k = 0; k < seen.size(); ++k) field[(*pass)[k].from] = seen[k];
    }
}

void measure(GridWeights& w, const GridFluid& f) {
    const Block cells = f.grid.cells();
    w.cell_volume.assign(cells.size(), 0.0);
    for_each_place(cells, [&](const Place& p, std::size_t k) {
        if (f.unknown_pressure[k] >= 0) w.cell_volume[k] = f.open.cell[k] * f.grid.cell_volume(p);
    });
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        w.face_volume[c].assign(f.grid.faces(c).size(), 0.0);
        for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
            if (f.unknown[c][k] >= 0) w.face_volume[c][k] = control_volume(f, c, p);
        });
    }
}

void set_weights(GridWeights& w, const GridFluid& f, const std::vector<Vec3>& x) {
    w.cells = columns(w, f, x, -1);
    for (std::size_t c = 0; c < f.dimensions(); ++c) w.faces[c] = columns(w, f, x, static_cast<int>(c));
}

Vec3 gathered_velocity(const GridWeights& w, const Velocity& u, std::size_t j) {
    Vec3 v = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c)
        if (w.faces[c].begin.size() > 1)
            v[static_cast<Eigen::Index>(c)] = w.faces[c].gathered(j, 0.0, [&](std::size_t k) { return u[c][k]; });
    return v;
}

BoundedPorosity porosity(const GridFluid& f, const GridWeights& w, const std::vector<double>& volume, double least) {
    Field<double> solid(f.eps.size(), 0.0);
    for (std::size_t j = 0; j < volume.size(); ++j)
        w.cells.spread(j, [&](std::size_t k, double weight) { solid[k] += weight * volume[j]; });
    BoundedPorosity found;
    found.bounded = relieve(f, w.cell_volume, 1.0 - least, solid, found.relief);
    found.eps.assign(solid.size(), 1.0);
    for (std::size_t k = 0; k < solid.size(); ++k)
        if (w.cell_volume[k] > 0.0) found.eps[k] = std::max(1.0 - solid[k] / w.cell_volume[k], least);
    return found;
}

Field<double> per_volume(const GridWeights& w, const Relief& relief, const std::vector<double>& of_grains) {
    Field<double> sum(w.cell_volume.size(), 0.0);
    for (std::size_t j = 0; j < of_grains.size(); ++j)
        if (of_grains[j] != 0.0)
            w.cells.spread(j, [&](std::size_t k, double weight) { sum[k] += weight * of_grains[j]; });
    relief.spread(sum);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = w.cell_volume[k] > 0.0 ? sum[k] / w.cell_volume[k] : 0.0;
    return sum;
}

namespace {

/// Differences of the pressure over the faces of a cell, and friction on them, as forces on its open volume [N/m3].
Vec3 stress_in(const GridFluid& f, const std::array<Field<double>, 3>& friction, const Place& p, double volume) {
    const Block cells = f.grid.cells();
    Vec3 force = Vec3::Zero();
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const Axis& axis = f.grid.axis[c];
        const Block faces = f.grid.faces(c);
        for (const int way : {0, 1}) {
            Place face = p, q = p;
            if (way == 1) face[c] = axis.face_above(p[c]);
            const std::size_t k = faces.at(face);
            if (f.unknown[c][k] < 0) continue;
            q[c] = axis.next(p[c], way);
            const double own = f.p[cells.at(p)];
            const double other = q[c] >= 0 ? f.p[cells.at(q)] : f.sides[c][static_cast<std::size_t>(way)].pressure;
            const double area = f.open.face[c][k] * f.grid.face_area(c, face);
            // half of what acts on the face's control volume belongs to this cell; all where no cell is beyond
            const double share = q[c] >= 0 ? 0.5 : 1.0;
            force[static_cast<Eigen::Index>(c)] +=
                share * ((way == 0 ? other - own : own - other) * area + friction[c][k]);
        }
    }
    return force / volume;
}

/// Velocity gradient in a cell by the mean velocities of its neighbours; zero inside of solids.
Eigen::Matrix3d gradient_in(const GridFluid& f, const Place& p) {
    const auto mean = [&](const Place& q, std::size_t c) {
        Place above = q;
        above[c] = f.grid.axis[c].face_above(q[c]);
        const Block faces = f.grid.faces(c);
        return 0.5 * (f.u[c][faces.at(q)] + f.u[c][faces.at(above)]);
    };
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (std::size_t d = 0; d < f.dimensions(); ++d) {
            const Axis& axis = f.grid.axis[d];
            Place below = p, above = p;
            double distance = 0.0;
            for (const int way : {0, 1}) {
                const int next = axis.next(p[d], way);
                if (next < 0) continue;
                (way == 0 ? below : above)[d] = next;
                distance += 0.5 * (axis.width(p[d]) + axis.width(next));
            }
            if (distance > 0.0)
                gradient(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(d)) =
                    (mean(above, c) - mean(below, c)) / distance;
        }
    return gradient;
}

} // namespace

CellFields cell_fields(const GridFluid& f, bool with_gradient) {
    std::array<Field<double>, 3> friction;
    for (std::size_t c = 0; c < f.dimensions(); ++c) friction[c] = friction_on_faces(f, c);
    CellFields fields;
    const Block cells = f.grid.cells();
    fields.stress.assign(cells.size(), Vec3::Zero());
    if (with_gradient) fields.gradient.assign(cells.size(), Eigen::Matrix3d::Zero());
    parallel_for(cells.size(), [&](std::size_t k) {
        if (f.unknown_pressure[k] < 0) return;
        const Place p = cells.place(k);
        fields.stress[k] = stress_in(f, friction, p, f.open.cell[k] * f.grid.cell_volume(p));
        if (with_gradient) fields.gradient[k] = gradient_in(f, p);
    });
    return fields;
}

} // namespace plumb
