#include "run/result_files.hpp"

#include "core/errors.hpp"
#include "grid/sums.hpp"
#include "run/aside_file.hpp"
#include "run/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <unistd.h>
#include <utility>

namespace plumb {

namespace {

namespace fs = std::filesystem;

/// True for a name that a run gives to a snapshot, complete or aside.
bool is_snapshot_name(const std::string& name) {
    const std::string stem = name.substr(0, name.find('.'));
    const bool number = stem.size() >= 6 && stem.find_first_not_of("0123456789") == std::string::npos;
    const std::string rest = name.substr(stem.size());
    return (number || stem == "diverged") && (rest == ".h5" || rest == ".h5.tmp");
}

void remove_file(const fs::path& path) {
    std::error_code error;
    fs::remove(path, error);
    if (error) throw IoError(fmt::format("{}: cannot be removed: {}", path.string(), error.message()));
}

/// Removes the results of an earlier run. What else is in the folder stays.
void remove_results(const std::string& path) {
    for (const char* name : {"checkpoint.h5", "result.xdmf", "series.h5"})
        for (const char* ending : {"", ".tmp"}) remove_file(path + "/" + name + ending);
    const fs::path snapshots = path + "/snapshots";
    std::error_code error;
    std::vector<fs::path> old;
    for (fs::directory_iterator entry(snapshots, error), end; !error && entry != end; entry.increment(error))
        if (is_snapshot_name(entry->path().filename().string())) old.push_back(entry->path());
    for (const fs::path& file : old) remove_file(file);
    fs::remove(snapshots, error); // stays if it holds something else
    remove_file(path + "/run.json.tmp");
    remove_file(path + "/run.json");
}

/// Numbers of a field of vectors or scalars in the order of ids.
std::vector<double> in_id_order(const std::vector<Vec3>& field, const std::vector<std::int32_t>& place) {
    std::vector<double> values;
    values.reserve(3 * place.size());
    for (const std::int32_t k : place)
        for (Eigen::Index c = 0; c < 3; ++c) values.push_back(field[static_cast<std::size_t>(k)][c]);
    return values;
}

template <class T> std::vector<T> in_id_order(const std::vector<T>& field, const std::vector<std::int32_t>& place) {
    std::vector<T> values;
    values.reserve(place.size());
    for (const std::int32_t k : place) values.push_back(field[static_cast<std::size_t>(k)]);
    return values;
}

void write_grains(Hdf5Writer& file, const Grains& g) {
    const std::vector<std::int32_t> place = positions_of_ids(g);
    std::vector<double> diameter = in_id_order(g.radius, place);
    for (double& d : diameter) d *= 2.0;
    const Shape vectors{g.size(), 3};
    file.write("grains/x", in_id_order(g.x, place), vectors);
    file.write("grains/v", in_id_order(g.v, place), vectors);
    file.write("grains/omega", in_id_order(g.omega, place), vectors);
    file.write("grains/diameter", diameter);
    file.write("grains/id", in_id_order(g.id, place));
    file.write("grains/group", in_id_order(g.group, place));
    for (const auto& [name, units] :
         {std::pair{"x", "m"}, {"v", "m/s"}, {"omega", "rad/s"}, {"diameter", "m"}, {"id", "1"}, {"group", "1"}})
        file.attribute(fmt::format("grains/{}", name), "units", std::string(units));
}

/// Particles in the order of ids; vectors have three components, the third 0 in the plane.
void write_fluid(Hdf5Writer& file, const SphFluid& f) {
    const std::vector<std::int32_t> slot = ordered_slots(f);
    const std::size_t n = slot.size();
    std::vector<double> x(3 * n), v(3 * n), rho(n), p(n), eps, mass;
    std::vector<std::int32_t> id(n);
    for (std::size_t k = 0; k < n; ++k) {
        const auto s = static_cast<std::size_t>(slot[k]);
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
            x[3 * k + c] = f.x[c][s];
            v[3 * k + c] = f.v[c][s];
        }
        const double share = f.among_grains() ? f.share[s] : 1.0;
        rho[k] = share * f.rho[s];
        if (f.among_grains()) eps.push_back(f.eps[s]), mass.push_back(share * f.mass);
        p[k] = pressure(f, f.among_grains() ? rho[k] / f.eps[s] : rho[k]);
        id[k] = f.id[s];
    }
    file.write("fluid/x", std::span<const double>(x), {n, 3});
    file.write("fluid/v", std::span<const double>(v), {n, 3});
    file.write("fluid/rho", rho);
    file.write("fluid/p", p);
    file.write("fluid/id", id);
    if (f.among_grains()) {
        file.write("fluid/eps", eps);
        file.attribute("fluid/eps", "units", std::string("1"));
        file.write("fluid/mass", mass);
        file.attribute("fluid/mass", "units", std::string("kg"));
    }
    for (const auto& [name, units] : {std::pair{"x", "m"}, {"v", "m/s"}, {"rho", "kg/m3"}, {"p", "Pa"}, {"id", "1"}})
        file.attribute(fmt::format("fluid/{}", name), "units", std::string(units));
}

/// Open cells as points, as smoothed particles are written, and the grid with its velocities on faces.
void write_fluid(Hdf5Writer& file, const GridFluid& f) {
    std::vector<double> x, v, p, rho, open;
    std::vector<std::int32_t> id;
    for_each_place(f.grid.cells(), [&](const Place& cell, std::size_t k) {
        if (f.unknown_pressure[k] < 0) return;
        const Vec3 centre = f.grid.centre(cell), velocity = centre_velocity(f, cell);
        x.insert(x.end(), {centre[0], centre[1], centre[2]});
        v.insert(v.end(), {velocity[0], velocity[1], velocity[2]});
        p.push_back(f.p[k]);
        rho.push_back(f.eps[k] * f.density);
        open.push_back(f.open.cell[k]);
        id.push_back(f.unknown_pressure[k]);
    });
    const std::size_t n = id.size();
    file.write("fluid/x", std::span<const double>(x), {n, 3});
    file.write("fluid/v", std::span<const double>(v), {n, 3});
    file.write("fluid/rho", rho);
    file.write("fluid/p", p);
    file.write("fluid/open", open);
    file.write("fluid/id", id);
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const Block faces = f.grid.faces(c);
        const std::string axis(1, axis_names[c]);
        file.write("grid/nodes_" + axis, f.grid.axis[c].node);
        file.write("grid/u_" + axis, std::span<const double>(f.u[c]),
                   {static_cast<std::size_t>(faces.n[2]), static_cast<std::size_t>(faces.n[1]),
                    static_cast<std::size_t>(faces.n[0])});
        file.attribute("grid/nodes_" + axis, "units", std::string("m"));
        file.attribute("grid/u_" + axis, "units", std::string("m/s"));
    }
    for (const auto& [name, units] :
         {std::pair{"x", "m"}, {"v", "m/s"}, {"rho", "kg/m3"}, {"p", "Pa"}, {"open", "1"}, {"id", "1"}})
        file.attribute(fmt::format("fluid/{}", name), "units", std::string(units));
}

/// Particles of walls and open sides with the state that the fluid saw last; `side` numbers the open sides, -1 at
/// walls; `mass` is what a buffer's particle brings when it comes in.
void write_boundary(Hdf5Writer& file, const SphFluid& f) {
    const std::size_t n = f.boundary.size();
    if (n == 0) return;
    std::vector<double> x(3 * n), v(3 * n), p(n);
    for (std::size_t k = 0; k < n; ++k) {
        const FluidRecord& r = f.clusters.records[static_cast<std::size_t>(f.clusters.record_of_passive[k])];
        const std::array<double, 3> velocity{r.u, r.v, r.w};
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
            x[3 * k + c] = f.boundary.x[c][k];
            v[3 * k + c] = velocity[c];
        }
        p[k] = own_pressure(f, pressure_of(f, r), f.boundary.eps[k]);
    }
    file.write("walls/x", std::span<const double>(x), {n, 3});
    file.write("walls/v", std::span<const double>(v), {n, 3});
    file.write("walls/p", p);
    file.write("walls/side", f.boundary.side);
    std::vector<double> mass(n);
    for (std::size_t k = 0; k < n; ++k) mass[k] = f.mass * f.boundary.share[k];
    file.write("walls/mass", mass);
    for (const auto& [name, units] : {std::pair{"x", "m"}, {"v", "m/s"}, {"p", "Pa"}, {"side", "1"}, {"mass", "kg"}})
        file.attribute(fmt::format("walls/{}", name), "units", std::string(units));
}

/// What a set of points of a snapshot shows in ParaView.
struct PointSet {
    std::string_view name; // group of the file
    std::size_t count;
    std::vector<std::string_view> vectors, scalars, integers;
};

std::string data_item(const SnapshotEntry& s, const PointSet& set, std::string_view field, std::size_t width,
                      bool integer) {
    const std::string shape = width == 1 ? fmt::format("{}", set.count) : fmt::format("{} {}", set.count, width);
    const std::string_view type = integer ? R"(NumberType="Int" Precision="4")" : R"(NumberType="Float" Precision="8")";
    return fmt::format("<DataItem Dimensions=\"{}\" {} Format=\"HDF\">{}:/{}/{}</DataItem>", shape, type, s.file,
                       set.name, field);
}

/// One snapshot. Its cells are the points themselves; their numbers are the ids, because the rows are in that order
/// (one of ParaView's two readers makes no cells without them).
std::string xdmf_grid(const SnapshotEntry& s, const PointSet& set) {
    std::string text =
        fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n"
                    "        <Time Value=\"{:.17g}\"/>\n"
                    "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" "
                    "NodesPerElement=\"1\">{}</Topology>\n"
                    "        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                    set.name, s.time, set.count, data_item(s, set, "id", 1, true), data_item(s, set, "x", 3, false));
    const auto attributes = [&](const std::vector<std::string_view>& names, std::string_view type, std::size_t width,
                                bool integer) {
        for (const std::string_view name : names)
            text += fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                                name, type, data_item(s, set, name, width, integer));
    };
    attributes(set.vectors, "Vector", 3, false);
    attributes(set.scalars, "Scalar", 1, false);
    attributes(set.integers, "Scalar", 1, true);
    return text + "      </Grid>\n";
}

} // namespace

void check_result_folder(const std::string& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) return;
    if (!fs::is_directory(status)) throw InputError(fmt::format("{}: is a file, not a folder for results", path));
    if (fs::exists(path + "/run.json", error)) return;
    const bool empty = fs::is_empty(path, error);
    if (error) throw IoError(fmt::format("{}: {}", path, error.message()));
    if (!empty)
        throw InputError(
            fmt::format("{}: the folder holds something that is no plumb result; choose another one with -o", path));
}

ResultFolder::ResultFolder(std::string path) : path_(std::move(path)) {}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

ResultFolder::~ResultFolder() {
    if (lock_ >= 0) ::close(lock_);
}

void ResultFolder::lock() {
    lock_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) fail_io(path_, "opened", errno);
    // Only a lock held by someone counts; some file systems know no locks.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw InputError(fmt::format("{}: another run is writing there", path_));
}

ResultFolder ResultFolder::fresh(const std::string& path) {
    check_result_folder(path);
    make_folder(path);
    ResultFolder folder(path);
    folder.lock();
    remove_results(path);
    return folder;
}

ResultFolder ResultFolder::existing(const std::string& path) {
    if (!fs::is_directory(path)) throw InputError(fmt::format("{}: there is no such result folder", path));
    ResultFolder folder(path);
    folder.lock();
    return folder;
}

std::string snapshot_name(std::int64_t output) { return fmt::format("snapshots/{:06d}.h5", output); }

void write_series(const std::string& path, const std::vector<Probe>& probes) {
    Hdf5Writer file(path);
    for (const Probe& probe : probes) {
        const std::string time = probe.name + "/time", value = probe.name + "/value";
        file.write(time, probe.time);
        file.attribute(time, "units", std::string("s"));
        const Shape shape = probe.per_grain() ? Shape{probe.time.size(), probe.width} : Shape{probe.time.size()};
        file.write(value, probe.value, shape);
        file.attribute(value, "units", probe.units());
        file.attribute(probe.name, "quantity", law_name(probe.quantity));
    }
    file.finish();
}

void write_snapshot(const std::string& path, const Simulation& simulation) {
    Hdf5Writer file(path);
    if (simulation.grains.grains.size() > 0 || !(simulation.sph || simulation.grid))
        write_grains(file, simulation.grains.grains);
    if (simulation.grid) write_fluid(file, *simulation.grid);
    if (simulation.sph) {
        write_fluid(file, *simulation.sph);
        write_boundary(file, *simulation.sph);
    }
    file.attribute("/", "time", static_cast<double>(simulation.grains.step) * simulation.timing.dt);
    file.attribute("/", "time_units", std::string("s"));
    file.attribute("/", "step", simulation.grains.step);
    file.finish();
}

void write_xdmf(const std::string& path, const std::vector<SnapshotEntry>& snapshots) {
    std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
                       "    <Grid Name=\"time\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const SnapshotEntry& s : snapshots) {
        const auto fluid = [&] { return xdmf_grid(s, {"fluid", s.particles, {"v"}, {"rho", "p"}, {"id"}}); };
        const auto grains = [&] {
            return xdmf_grid(s, {"grains", s.grains, {"v", "omega"}, {"diameter"}, {"id", "group"}});
        };
        if (s.particles > 0 && s.grains > 0)
            text += fmt::format("      <Grid Name=\"both\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
                                "        <Time Value=\"{:.17g}\"/>\n{}{}      </Grid>\n",
                                s.time, fluid(), grains());
        else
            text += s.particles > 0 ? fluid() : grains();
    }
    text += "    </Grid>\n  </Domain>\n</Xdmf>\n";
    write_text(path, text);
}

} // namespace plumb
