#include "run/aside_file.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace plumb {

namespace {

/// An open file descriptor; close() errors are checked by `finish`, the destructor is for the error path.
class Descriptor {
public:
    Descriptor(const std::string& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int number() const { return number_; }
    bool finish() {
        const int number = number_;
        number_ = -1;
        return ::close(number) == 0;
    }

private:
    int number_;
};

/// 0, or the errno value of what failed.
int write_all(int descriptor, std::string_view content) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

} // namespace

std::string aside_name(const std::string& path) { return path + ".tmp"; }

void fail_io(const std::string& path, std::string_view what, int code) {
    throw IoError(fmt::format("{}: cannot be {}: {}", path, what, std::strerror(code)));
}

void publish(const std::string& path) {
    const std::string aside = aside_name(path);
    if (::rename(aside.c_str(), path.c_str()) == 0) return;
    const int code = errno;
    ::unlink(aside.c_str());
    fail_io(path, "replaced", code);
}

void flush_to_disk(const std::string& path) {
    Descriptor file(path, O_RDONLY);
    if (file.number() < 0 || ::fsync(file.number()) != 0 || !file.finish()) fail_io(path, "written", errno);
    // Some file systems do not allow to flush a folder, which is no loss.
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const Descriptor folder(parent.empty() ? "." : parent.string(), O_RDONLY | O_DIRECTORY);
    if (folder.number() >= 0) ::fsync(folder.number());
}

void write_text(const std::string& path, std::string_view content) {
    const std::string aside = aside_name(path);
    Descriptor file(aside, O_WRONLY | O_CREAT | O_TRUNC);
    if (file.number() < 0) fail_io(path, "written", errno);
    int code = write_all(file.number(), content);
    if (!file.finish() && code == 0) code = errno;
    if (code != 0) {
        ::unlink(aside.c_str());
        fail_io(path, "written", code);
    }
    publish(path);
}

void make_folder(const std::string& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) throw IoError(fmt::format("{}: the folder cannot be made: {}", path, error.message()));
}

} // namespace plumb
