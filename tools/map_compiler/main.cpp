// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_map: compiles a map source to BSP version 38, or to QBSP. Exit status: 0 done, 1 failed, 2 wrong use.
#include "tools/map_compiler/compiler.hpp"
#include "tools/map_compiler/textures.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <fmt/format.h>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using namespace vkpt::tools;

struct Arguments {
    fs::path source, output, textures;
    bool no_light = false, no_visibility = false, extended = false;
    int threads = 0;
};

void write_file(const fs::path& path, const void* bytes, size_t size)
{
    std::ofstream stream(path, std::ios::binary);
    stream.write(static_cast<const char*>(bytes), std::streamsize(size));
    stream.close();
    if (!stream)
        throw MapError(path.string(), 0, "cannot be written; check the folder, the permissions and the space left");
}

// The line through the hole, as editors load it: a point per line.
fs::path write_point_file(const fs::path& output, const std::vector<dvec3>& points)
{
    fs::path path = output;
    path.replace_extension(".pts");
    std::string text;
    for (const dvec3& p : points)
        text += fmt::format("{:.2f} {:.2f} {:.2f}\n", p.x, p.y, p.z);
    write_file(path, text.data(), text.size());
    return path;
}

void compile(const Arguments& arguments)
{
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::byte> source = read_file(arguments.source);
    CompileOptions options;
    options.textures = arguments.textures;
    options.light = !arguments.no_light;
    options.visibility = !arguments.no_visibility;
    options.format = arguments.extended ? formats::BspFormat::qbsp : formats::BspFormat::ibsp;
    options.threads = arguments.threads;
    options.warn = [](const std::string& text) { fmt::print(stderr, "warning: {}\n", text); };
    options.progress = [](const std::string& text) { fmt::print("  {}\n", text); };
    fmt::print("{}\n", arguments.source.string());
    const std::string_view text(reinterpret_cast<const char*>(source.data()), source.size());
    const formats::Bsp bsp = compile_map(text, arguments.source.string(), options);
    const std::vector<std::byte> file = formats::write_bsp(bsp);
    write_file(arguments.output, file.data(), file.size());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("  {}: {} faces, {} leaves, {} models, {} bytes of light, {:.1f} s\n", arguments.output.string(),
        bsp.faces.size(), bsp.leaves.size(), bsp.models.size(), bsp.lighting.size(), seconds.count());
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app("Compiles a Quake II .map to a BSP (version 38) with visibility and baked light");
    Arguments arguments;
    app.add_option("source", arguments.source, "map source, as TrenchBroom or GtkRadiant save it")->required();
    app.add_option("-o,--output", arguments.output, "compiled map")->required();
    app.add_option("--textures", arguments.textures, "folder of the .wal files (their flags and colours)");
    app.add_flag("--no-light", arguments.no_light, "bake no lightmaps");
    app.add_flag("--no-vis", arguments.no_visibility, "write no visible sets: everything sees everything");
    app.add_flag("--qbsp", arguments.extended,
        "write the extended format (QBSP), for maps too large for Quake II's own; Yamagi Quake II does not load it");
    app.add_option("--light-threads", arguments.threads, "threads for visibility and light; 0: all")
        ->check(CLI::Range(0, 256));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        compile(arguments);
    } catch (const LeakError& leak) {
        fmt::print(stderr, "error: {}\n", leak.what());
        try {
            fmt::print(stderr, "  line of points: {}\n", write_point_file(arguments.output, leak.points()).string());
        } catch (const std::exception& error) {
            fmt::print(stderr, "error: {}\n", error.what());
        }
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
    return 0;
}
