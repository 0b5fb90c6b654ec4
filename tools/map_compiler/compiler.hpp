// SPDX-License-Identifier: GPL-2.0-or-later
// The whole way from map text to a compiled map.
#pragma once

#include "formats/bsp.hpp"
#include "tools/map_compiler/brushes.hpp"
#include "tools/map_compiler/map_source.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace vkpt::tools {

struct CompileOptions {
    std::filesystem::path textures; // folder with .wal files; empty: none
    bool light = true, visibility = true;
    formats::BspFormat format = formats::BspFormat::ibsp;
    int threads = 0; // 0: as many as the machine has
    WarningSink warn = [](const std::string&) {};
    WarningSink progress = [](const std::string&) {};
};

// A way from an entity to the outside: the map is not closed.
class LeakError : public MapError {
public:
    LeakError(std::string_view file, int line, std::string_view reason, std::vector<dvec3> points)
        : MapError(file, line, reason)
        , points_(std::move(points))
    {
    }
    // From the outside to the entity, through the hole.
    const std::vector<dvec3>& points() const { return points_; }

private:
    std::vector<dvec3> points_;
};

// `file` is the name for messages. Throws MapError, LeakError, formats::FormatError (a picture).
formats::Bsp compile_map(std::string_view text, std::string_view file, const CompileOptions& options);

} // namespace vkpt::tools
