// Files that are complete or absent: written aside and renamed.
#pragma once

#include <string>
#include <string_view>

namespace plumb {

/// Name under which the file `path` is written before it is complete; in the same folder, hence on the same disk.
std::string aside_name(const std::string& path);

/// Gives the finished file at aside_name(path) its name, replacing an older one in one step: whenever the process is
/// killed, the name stands for a complete file. Throws IoError with the system's reason; the older file then stays as
/// it was and the one written aside is removed.
void publish(const std::string& path);

/// Waits until the file at `path` and its name are on the disk, so that even a power cut cannot take them. Slow, hence
/// only for what took long to compute. Throws IoError with the system's reason.
void flush_to_disk(const std::string& path);

/// Writes `content` as the file `path`, aside first. Throws IoError; an older file then stays as it was.
void write_text(const std::string& path, std::string_view content);

/// Makes the folder and those above it. Throws IoError with the system's reason.
void make_folder(const std::string& path);

/// Throws the IoError "<path>: cannot be <what>: <reason of errno value `code`>".
[[noreturn]] void fail_io(const std::string& path, std::string_view what, int code);

} // namespace plumb
