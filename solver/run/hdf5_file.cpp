#include "run/hdf5_file.hpp"

#include "core/errors.hpp"
#include "run/aside_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <unistd.h>
#include <utility>

namespace plumb {

namespace {

/// Prepares the library once: errors are ours to report, and nothing may happen behind our back at exit (after a full
/// disk the library would try, and fail, to flush again).
void prepare_library() {
    static const bool done = [] {
        H5dont_atexit();
        H5open();
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        return true;
    }();
    (void)done;
}

/// The system's reason as the library noted it in the stack of its last error, or its innermost description.
std::string library_reason() {
    std::string reason;
    const auto look = [](unsigned /*depth*/, const H5E_error2_t* entry, void* found) -> herr_t {
        auto& text = *static_cast<std::string*>(found);
        const std::string description = entry->desc != nullptr ? entry->desc : "";
        const std::size_t at = description.find("errno = ");
        if (at != std::string::npos)
            text = std::strerror(std::atoi(description.c_str() + at + std::strlen("errno = ")));
        else if (text.empty())
            text = description;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &reason);
    return reason.empty() ? "unknown reason" : reason;
}

Hdf5Handle text_type() {
    Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), H5T_VARIABLE);
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    return type;
}

Hdf5Handle space_of(const Shape& shape) {
    if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
    const std::vector<hsize_t> extent(shape.begin(), shape.end());
    return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose};
}

std::size_t product(const Shape& shape) {
    std::size_t count = 1;
    for (const std::size_t n : shape) count *= n;
    return count;
}

/// How objects of a class are made: without the time of day that the library would put into their headers.
Hdf5Handle without_times(hid_t of_class) {
    Hdf5Handle how(H5Pcreate(of_class), H5Pclose);
    H5Pset_obj_track_times(how.get(), false);
    return how;
}

} // namespace

bool Hdf5Handle::close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
}

Hdf5Writer::Hdf5Writer(std::string path, bool checked)
    : path_(std::move(path)), checked_(checked), file_(created_file()) {}

Hdf5Handle Hdf5Writer::created_file() const {
    prepare_library();
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation = without_times(H5P_FILE_CREATE);
    // Since version 1.10 of the format the library's own records carry checksums too.
    if (checked_) H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_LATEST);
    Hdf5Handle file(H5Fcreate(aside_name(path_).c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
    if (!file.valid()) fail();
    return file;
}

Hdf5Writer::~Hdf5Writer() {
    if (!file_.valid()) return;
    file_.close();
    ::unlink(aside_name(path_).c_str());
}

void Hdf5Writer::fail() const { throw IoError(fmt::format("{}: cannot be written: {}", path_, library_reason())); }

void Hdf5Writer::write_raw(const std::string& name, const void* data, std::size_t count, hid_t type,
                           const Shape& shape) {
    assert(count == product(shape));
    make_groups(name);
    const Hdf5Handle layout = without_times(H5P_DATASET_CREATE);
    if (checked_ && count > 0) {
        std::vector<hsize_t> chunk(shape.begin(), shape.end());
        chunk[0] = std::min<hsize_t>(chunk[0], std::max<hsize_t>(1, 65536 * chunk[0] / count)); // about half a megabyte
        H5Pset_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
        H5Pset_fletcher32(layout.get());
    }
    const Hdf5Handle space = space_of(shape);
    Hdf5Handle set(H5Dcreate2(file_.get(), name.c_str(), type, space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
                   H5Dclose);
    if (!set.valid()) fail();
    if (count > 0 && H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) fail();
    if (!set.close()) fail();
}

void Hdf5Writer::write(const std::string& name, std::span<const double> data, const Shape& shape) {
    write_raw(name, data.data(), data.size(), H5T_NATIVE_DOUBLE, shape);
}
void Hdf5Writer::write(const std::string& name, std::span<const std::int32_t> data, const Shape& shape) {
    write_raw(name, data.data(), data.size(), H5T_NATIVE_INT32, shape);
}
void Hdf5Writer::write(const std::string& name, std::span<const std::int64_t> data, const Shape& shape) {
    write_raw(name, data.data(), data.size(), H5T_NATIVE_INT64, shape);
}

void Hdf5Writer::write_bytes(const std::string& name, const std::string& text) {
    write_raw(name, text.data(), text.size(), H5T_NATIVE_UCHAR, {text.size()});
}

void Hdf5Writer::make_groups(const std::string& name) {
    const Hdf5Handle plain = without_times(H5P_GROUP_CREATE);
    for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
        const std::string group = name.substr(0, slash);
        if (H5Lexists(file_.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
        const Hdf5Handle made(H5Gcreate2(file_.get(), group.c_str(), H5P_DEFAULT, plain.get(), H5P_DEFAULT), H5Gclose);
        if (!made.valid()) fail();
    }
}

void Hdf5Writer::attribute_raw(const std::string& object, const std::string& name, hid_t type, const void* value) {
    const Hdf5Handle owner(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
    const Hdf5Handle space = space_of({});
    const Hdf5Handle made(H5Acreate2(owner.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!made.valid() || H5Awrite(made.get(), type, value) < 0) fail();
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, const std::string& text) {
    const Hdf5Handle type = text_type();
    const char* bytes = text.c_str();
    attribute_raw(object, name, type.get(), &bytes);
}
void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
    attribute_raw(object, name, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::int64_t value) {
    attribute_raw(object, name, H5T_NATIVE_INT64, &value);
}

void Hdf5Writer::finish() {
    if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0) fail();
    if (!file_.close()) {
        ::unlink(aside_name(path_).c_str());
        fail();
    }
    publish(path_);
}

Hdf5Reader::Hdf5Reader(std::string path)
    : path_(std::move(path)), file_([this] {
          prepare_library();
          return Hdf5Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
      }()) {
    if (file_.valid()) return;
    if (::access(path_.c_str(), R_OK) != 0) fail_io(path_, "read", errno);
    throw IoError(fmt::format("{}: is not a complete HDF5 file", path_));
}

void Hdf5Reader::fail(const std::string& what) const { throw IoError(fmt::format("{}: {}", path_, what)); }

bool Hdf5Reader::has(const std::string& name) const {
    for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1))
        if (H5Lexists(file_.get(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Reader::datasets() const {
    std::vector<std::string> names;
    const auto note = [](hid_t /*group*/, const char* name, const H5O_info_t* info, void* found) -> herr_t {
        if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
        return 0;
    };
    if (H5Ovisit2(file_.get(), H5_INDEX_NAME, H5_ITER_INC, note, &names, H5O_INFO_BASIC) < 0) fail("is damaged");
    std::sort(names.begin(), names.end());
    return names;
}

Hdf5Handle Hdf5Reader::dataset(const std::string& name) const {
    Hdf5Handle set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) fail(fmt::format("has no readable dataset {}", name));
    return set;
}

Shape Hdf5Reader::shape(const std::string& name) const {
    const Hdf5Handle set = dataset(name);
    const Hdf5Handle space(H5Dget_space(set.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 0) fail(fmt::format("{} is damaged", name));
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
    return {extent.begin(), extent.end()};
}

bool Hdf5Reader::is_integer(const std::string& name) const {
    const Hdf5Handle set = dataset(name);
    const Hdf5Handle type(H5Dget_type(set.get()), H5Tclose);
    return H5Tget_class(type.get()) == H5T_INTEGER;
}

void Hdf5Reader::read_raw(const std::string& name, hid_t type, void* data) const {
    const Hdf5Handle set = dataset(name);
    if (H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) fail(fmt::format("{} is damaged", name));
}

std::vector<double> Hdf5Reader::doubles(const std::string& name) const {
    std::vector<double> values(product(shape(name)));
    if (!values.empty()) read_raw(name, H5T_NATIVE_DOUBLE, values.data());
    return values;
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& name) const {
    if (!is_integer(name)) fail(fmt::format("{} does not hold whole numbers", name));
    std::vector<std::int64_t> values(product(shape(name)));
    if (!values.empty()) read_raw(name, H5T_NATIVE_INT64, values.data());
    return values;
}

std::string Hdf5Reader::bytes(const std::string& name) const {
    std::string values(product(shape(name)), '\0');
    if (!values.empty()) read_raw(name, H5T_NATIVE_UCHAR, values.data());
    return values;
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
    return H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Handle Hdf5Reader::attribute(const std::string& object, const std::string& name) const {
    Hdf5Handle found(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!found.valid()) fail(fmt::format("has no attribute {} of {}", name, object));
    return found;
}

void Hdf5Reader::read_attribute(const std::string& object, const std::string& name, hid_t type, void* value) const {
    const Hdf5Handle found = attribute(object, name);
    if (H5Aread(found.get(), type, value) < 0) fail(fmt::format("attribute {} of {} is damaged", name, object));
}

std::string Hdf5Reader::text(const std::string& object, const std::string& attribute) const {
    const Hdf5Handle type = text_type();
    char* bytes = nullptr;
    read_attribute(object, attribute, type.get(), &bytes);
    if (bytes == nullptr) return {};
    std::string value(bytes);
    H5free_memory(bytes);
    return value;
}

double Hdf5Reader::number(const std::string& object, const std::string& attribute) const {
    double value = 0.0;
    read_attribute(object, attribute, H5T_NATIVE_DOUBLE, &value);
    return value;
}

std::int64_t Hdf5Reader::integer(const std::string& object, const std::string& attribute) const {
    std::int64_t value = 0;
    read_attribute(object, attribute, H5T_NATIVE_INT64, &value);
    return value;
}

} // namespace plumb
