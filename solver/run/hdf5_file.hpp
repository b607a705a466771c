// The only file that talks to the HDF5 library.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>

namespace plumb {

using Shape = std::vector<std::size_t>; // extent per dimension; empty for a scalar

/// Owns one identifier of the library.
class Hdf5Handle {
public:
    using Close = herr_t (*)(hid_t);
    Hdf5Handle(hid_t id, Close closing) : id_(id), close_(closing) {}
    Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(Hdf5Handle&&) = delete;
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }
    hid_t get() const { return id_; }
    bool valid() const { return id_ >= 0; }
    /// Closes now; false if that failed, which is how a full disk may show.
    bool close();

private:
    hid_t id_;
    Close close_;
};

/// Writes a new file aside; only `finish` gives it its name. All members throw IoError with the system's reason, and a
/// file that was not finished is removed. The bytes written depend on the data only (no times inside).
class Hdf5Writer {
public:
    /// `checked`: all data carry checksums that are verified when they are read.
    explicit Hdf5Writer(std::string path, bool checked = false);
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;
    ~Hdf5Writer();

    /// Writes the dataset `name` ("group/name": groups are made) with row-major `data` of the given shape.
    void write(const std::string& name, std::span<const double> data, const Shape& shape);
    void write(const std::string& name, std::span<const std::int32_t> data, const Shape& shape);
    void write(const std::string& name, std::span<const std::int64_t> data, const Shape& shape);
    /// One-dimensional.
    template <class T> void write(const std::string& name, const std::vector<T>& data) {
        write(name, std::span<const T>(data), {data.size()});
    }
    /// The bytes of a text as a dataset; checked as any other.
    void write_bytes(const std::string& name, const std::string& text);
    /// Attribute `name` of the group or dataset `object` ("/" for the file).
    void attribute(const std::string& object, const std::string& name, const std::string& text);
    void attribute(const std::string& object, const std::string& name, double value);
    void attribute(const std::string& object, const std::string& name, std::int64_t value);

    void finish();

private:
    /// The groups that `name` lies in.
    void make_groups(const std::string& name);
    void write_raw(const std::string& name, const void* data, std::size_t count, hid_t type, const Shape& shape);
    void attribute_raw(const std::string& object, const std::string& name, hid_t type, const void* value);
    Hdf5Handle created_file() const;
    [[noreturn]] void fail() const;

    std::string path_;
    bool checked_;
    Hdf5Handle file_;
};

/// Reads a file. All members throw IoError "<path>: ..." for a file or dataset that is absent, broken or of another
/// kind.
class Hdf5Reader {
public:
    explicit Hdf5Reader(std::string path);

    bool has(const std::string& name) const;
    /// Names of all datasets, "group/name", in alphabetical order.
    std::vector<std::string> datasets() const;
    Shape shape(const std::string& name) const;
    bool is_integer(const std::string& name) const;
    /// Row-major content; integers are converted to the asked type if it holds them exactly.
    std::vector<double> doubles(const std::string& name) const;
    std::vector<std::int64_t> integers(const std::string& name) const;
    std::string bytes(const std::string& name) const;
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text(const std::string& object, const std::string& attribute) const;
    double number(const std::string& object, const std::string& attribute) const;
    std::int64_t integer(const std::string& object, const std::string& attribute) const;
    const std::string& path() const { return path_; }

private:
    Hdf5Handle dataset(const std::string& name) const;
    void read_raw(const std::string& name, hid_t type, void* data) const;
    Hdf5Handle attribute(const std::string& object, const std::string& name) const;
    void read_attribute(const std::string& object, const std::string& name, hid_t type, void* value) const;
    [[noreturn]] void fail(const std::string& what) const;

    std::string path_;
    Hdf5Handle file_;
};

} // namespace plumb
