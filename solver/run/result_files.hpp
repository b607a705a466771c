// The result folder: which files there are and how they are laid out.
//
//   run.json               provenance and cost                 series.h5    /<probe>/time [nt], /<probe>/value [nt] or
//   [nt, n] snapshots/NNNNNN.h5    /grains/x v omega diameter id group and /fluid/x v rho p id, each in the order of
//   ids, where the scene has them; one file per output checkpoint.h5          everything `plumb resume` needs
//   result.xdmf  index of the snapshots for ParaView and PyVista
#pragma once

#include "run/probes.hpp"
#include "run/provenance.hpp"

#include <string>
#include <vector>

namespace plumb {

/// The folder of one run, held by this process alone while the object lives.
class ResultFolder {
public:
    /// Makes the folder, or empties the plumb result that is in it: its files are removed, run.json last, others stay.
    /// InputError for a folder that holds something else or is in use by another run; IoError as the system says.
    static ResultFolder fresh(const std::string& path);
    /// The folder of a run that is to be continued. InputError if there is none or if it is in use.
    static ResultFolder existing(const std::string& path);

    ResultFolder(ResultFolder&& other) noexcept;
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;
    ResultFolder& operator=(ResultFolder&&) = delete;
    ~ResultFolder();

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }

private:
    explicit ResultFolder(std::string path);
    void lock();

    std::string path_;
    int lock_ = -1;
};

/// InputError if `path` could not become a result folder: a file, or a folder with something else in it. Changes
/// nothing.
void check_result_folder(const std::string& path);

struct SnapshotEntry {
    std::string file;          // relative to the result folder
    double time;               // [s]
    std::size_t grains;        // in it
    std::size_t particles = 0; // of the fluid
};

/// "snapshots/000012.h5".
std::string snapshot_name(std::int64_t output);

/// All of these write aside and rename; IoError if the system refuses.
void write_series(const std::string& path, const std::vector<Probe>& probes);
void write_snapshot(const std::string& path, const Simulation& simulation);
void write_xdmf(const std::string& path, const std::vector<SnapshotEntry>& snapshots);

} // namespace plumb
