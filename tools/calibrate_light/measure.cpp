// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/calibrate_light/measure.hpp"

#include "client/host/client_map.hpp"
#include "client/host/errors.hpp"
#include "client/host/session_folder.hpp"
#include "common/colour.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace vkpt::tools {

namespace {

namespace fs = std::filesystem;

constexpr int view_size = 16; // pixels: the view itself is of no interest
constexpr const char* probe_map = "maps/vkpt_calibrate.bsp";

std::vector<std::byte> read_file(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<std::byte> bytes(file ? size_t(file.tellg()) : 0);
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
        throw client::Failure(fmt::format("{} cannot be read: {}", path.string(), std::strerror(errno)));
    return bytes;
}

// A folder that goes with its last user.
client::HostOptions make_host_options(const MeasureOptions& options, LightKind kind)
{
    client::HostOptions host;
    host.module = options.module;
    host.width = host.height = view_size;
    host.verbose = options.verbose;
    host.cvars = { { "pt_bounces", fmt::format("{}", options.bounces) }, { "pt_seed", fmt::format("{}", options.seed) },
        { "pt_sky_scale", kind == LightKind::sky ? "1" : "0" } };
    return host;
}

// Only lightstyle 0 shines: the others' lightmaps are separate.
engine::RefDef steady_view(client::ClientMap& scene, std::array<engine::Lightstyle, engine::max_lightstyles>& styles)
{
    styles.fill({});
    styles[0] = { { 1, 1, 1 }, 3 };
    engine::RefDef view = scene.view(view_size, view_size, 0);
    view.lightstyles = styles.data();
    return view;
}

std::vector<float> measure_kind(
    const formats::Bsp& bsp, const std::vector<Luxel>& luxels, LightKind kind, const MeasureOptions& options)
{
    const client::SessionFolder folder("vkpt-calibrate-");
    const fs::path file = folder.path() / "variant.bsp";
    const std::vector<std::byte> bytes = formats::write_bsp(keep_lights_of(bsp, kind));
    std::ofstream output(file, std::ios::binary);
    output.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    output.close();
    if (!output)
        throw client::Failure(fmt::format("{} cannot be written: {}", file.string(), std::strerror(errno)));

    client::FileSystem files(options.base_folder, options.game);
    client::SceneName name;
    name.map = probe_map;
    name.file = file;
    name.camera = client::Camera {};
    client::ClientMap scene(files, name);
    client::Host host(make_host_options(options, kind), &files);
    scene.register_with(host);
    std::array<engine::Lightstyle, engine::max_lightstyles> styles;
    host.draw_frame(steady_view(scene, styles));

    std::vector<IrradianceProbe> probes;
    for (const Luxel& luxel : luxels)
        probes.push_back({ { luxel.position.x, luxel.position.y, luxel.position.z },
            { luxel.normal.x, luxel.normal.y, luxel.normal.z } });
    std::vector<float> rgb(3 * probes.size());
    if (!host.extension().measure_irradiance(probes.data(), probes.size(), options.samples, rgb.data()))
        throw client::Failure(fmt::format("{}: the module measured nothing", bsp.name));
    return rgb;
}

} // namespace

MapComparison compare_map(const fs::path& file, const MeasureOptions& options)
{
    const formats::Bsp bsp = formats::read_bsp(read_file(file), file.string());
    const std::vector<Luxel> luxels = choose_luxels(collect_luxels(bsp), options.luxels, options.seed);
    MapComparison map;
    map.name = file.filename().string();
    if (luxels.empty())
        throw client::Failure(
            fmt::format("{}: no lightmap sample can be used: the map was compiled without light", file.string()));
    map.luxels.resize(luxels.size());
    for (size_t i = 0; i < luxels.size(); i++)
        map.luxels[i].baked = luminance(&luxels[i].baked.x);
    for (size_t kind = 0; kind < light_kind_count; kind++) {
        const std::vector<float> rgb = measure_kind(bsp, luxels, LightKind(kind), options);
        for (size_t i = 0; i < luxels.size(); i++)
            map.luxels[i].traced[kind] = luminance(&rgb[3 * i]);
    }
    return map;
}

} // namespace vkpt::tools
