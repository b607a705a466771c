// The scene file: read once, changed by --set, and kept as the text that a run was made from.
#pragma once

#include "core/table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// A scene as read. `root` is the strict reader of `data`; whoever builds something reads its tables there.
struct Scene {
    toml::table data;
    Table root;
    std::string path;                   // as given, for messages
    std::string folder;                 // absolute; files named by the scene are looked for here
    std::string text;                   // the scene after the overrides, as TOML; reading it again gives equal data
    std::string hash;                   // of `text`, "fnv1a64:<16 hex digits>"
    std::vector<std::string> overrides; // "key.path=value", as given
};

/// Reads the scene at `path` and applies `overrides` in their order. Throws InputError, one line each, for a file that
/// is missing, unreadable, no regular file, empty, larger than 16 MiB or not TOML, and for an override that has no
/// meaning.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides);

/// A scene from its text, for checkpoints and tests. Throws InputError as load_scene.
Scene scene_from_text(std::string_view text, const std::string& path, const std::string& folder,
                      const std::vector<std::string>& overrides = {});

/// 64-bit hash FNV-1a (Fowler, Noll & Vo; RFC 9923) of `bytes`: tells texts apart, protects against nothing.
std::uint64_t fnv1a64(std::string_view bytes);

} // namespace plumb
