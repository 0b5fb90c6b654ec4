// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/extension.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/engine/exports.hpp"
#include "ref_vkpt/free_memory.hpp"
#include "ref_vkpt/module.hpp"
#include "ref_vkpt/scene_contents.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

namespace vkpt {

namespace {

constexpr const char* denoisers[] = { "off", "temporal", "svgf", "asvgf", nullptr };

ImageSize frame_size()
{
    const Module* m = module();
    const VkExtent2D size = m ? m->graphics.size() : VkExtent2D {};
    return { int32_t(size.width), int32_t(size.height) };
}

bool capture_display(uint8_t* rgba)
{
    Module* m = module();
    if (!m || m->graphics.frame_number() == 0 || m->graphics.is_recording())
        return false;
    const OutputImage& output = m->graphics.output;
    const size_t bytes = size_t(output.size.width) * output.size.height * sizeof(uint32_t);
    std::memcpy(rgba, m->graphics.read_back(output.words, bytes).mapped(), bytes);
    if (output.highlights) // alpha is what 2D covers
        for (size_t alpha = 3; alpha < bytes; alpha += 4)
            rgba[alpha] = 255;
    return true;
}

bool capture_radiance(float* rgb)
{
    Module* m = module();
    return m && !m->graphics.is_recording() && m->frame.read_radiance(m->view(), rgb);
}

uint32_t accumulated_frames() { return module() ? module()->view().accumulated_frames : 0; }

const PassTime* pass_times(size_t* count)
{
    Module* m = module();
    *count = 0;
    if (!m || m->graphics.is_recording())
        return nullptr;
    m->graphics.finish();
    m->graphics.timer.read_back_all(m->graphics.slot());
    *count = m->graphics.timer.times().size();
    return m->graphics.timer.times().data();
}

void time_every_pass()
{
    if (Module* m = module())
        m->graphics.timer.time_every_pass();
}

void fill_world_counts(ModuleInfo& info, const Module& m)
{
    const World* world = m.scene.world();
    if (!world)
        return;
    info.triangles = world->models[0].triangles.size();
    info.dynamic_triangles = m.view().snapshot ? m.view().snapshot->moving.triangle_count() : 0;
    info.clusters = world->light_lists.lists().size() - 1;
    info.emitters = world->models[0].emitters.size() + (m.view().snapshot ? m.view().snapshot->emitters.size() : 0);
    const glm::dvec3 power = m.view().snapshot ? emitted_power(*m.view().snapshot) : glm::dvec3(0);
    for (int i = 0; i < 3; i++)
        info.emitted_power[i] = power[i];
    info.light_list_entries
        = world->light_lists.static_indices().size() + m.view().lights.lists.dynamic_indices().size();
}

void fill_trace(ModuleInfo& info, const Module& m)
{
    static std::vector<const char*> offered;
    offered.clear();
    for (const TraceBackend backend : offered_backends(m.graphics.device))
        offered.push_back(name_of(backend).data()); // literals
    offered.push_back(nullptr);
    info.trace_backends = offered.data();
    info.trace_backend = name_of(m.frame.trace_backend()).data();
    if (const World* world = m.scene.world())
        info.structure_bytes_per_triangle = m.frame.bytes_per_triangle(*world);
}

ModuleInfo module_info()
{
    static std::string version;
    static std::vector<const char*> samplers;
    static std::vector<uint32_t> sampler_traits;
    samplers.clear();
    sampler_traits.clear();
    for (const LightSampler& sampler : light_samplers()) {
        samplers.push_back(sampler.name);
        sampler_traits.push_back(sampler.traits);
    }
    samplers.push_back(nullptr);

    ModuleInfo info {};
    info.device = info.driver = info.vulkan_version = "";
    info.trace_backend = "";
    static const char* const no_backends[] = { nullptr };
    info.trace_backends = no_backends;
    info.light_samplers = samplers.data();
    info.light_sampler_traits = sampler_traits.data();
    info.denoisers = denoisers;
    const int32_t apis[] = { 5, 6, 7, 8 };
    std::ranges::copy(apis, info.api_versions);
    info.max_entities = engine::max_entities;
    info.max_dlights = engine::max_dlights;
    info.max_particles = engine::max_particles;
    Module* m = module();
    if (!m)
        return info;
    const Device& device = m->graphics.device;
    version = describe_api_version(device.properties.apiVersion);
    info.device = device.properties.deviceName;
    info.driver = device.driver.c_str();
    info.vulkan_version = version.c_str();
    info.max_image_size = int32_t(device.properties.limits.maxImageDimension2D);
    fill_trace(info, *m);
    fill_world_counts(info, *m);
    if (cvars::values().pt_count_rays != 0 && !m->graphics.is_recording()) {
        m->graphics.finish();
        const shared::RayCounts rays = m->frame.read_ray_counts();
        info.nearest_rays = rays.nearest;
        info.visibility_rays = rays.visible;
    }
    info.textures = m->textures.count();
    const MemoryAllocator& memory = m->graphics.memory;
    info.texture_bytes = memory.bytes_in_use(MemoryKind::textures);
    info.geometry_bytes = memory.bytes_in_use(MemoryKind::geometry);
    info.acceleration_bytes = memory.bytes_in_use(MemoryKind::acceleration);
    info.light_bytes = memory.bytes_in_use(MemoryKind::lights);
    info.image_bytes = memory.bytes_in_use(MemoryKind::images);
    info.staging_bytes = memory.bytes_in_use(MemoryKind::staging);
    return info;
}

bool measure_irradiance(const IrradianceProbe* probes, size_t count, uint32_t samples, float* rgb)
{
    Module* m = module();
    if (!m || !m->view().snapshot || m->graphics.is_recording())
        return false;
    if (count > 0)
        m->queries().measure_irradiance({ probes, count }, samples, rgb);
    return true;
}

double trace_rays(const TracedRay* rays, size_t count, const TraceRequest* request, TracedHit* hits)
{
    Module* m = module();
    if (!m || !m->view().snapshot || m->graphics.is_recording())
        return -1;
    return m->queries().trace_rays({ rays, count }, *request, hits);
}

const PassSamples* collected_times(size_t* count)
{
    static std::vector<PassSamples> samples;
    samples.clear();
    if (Module* m = module(); m && !m->graphics.is_recording()) {
        m->graphics.finish();
        m->graphics.timer.read_back_all(m->graphics.slot());
        for (const PassStatistics::Pass& pass : m->pass_statistics.passes())
            samples.push_back({ pass.name.c_str(), pass.milliseconds.data(), pass.milliseconds.size() });
    }
    *count = samples.size();
    return samples.data();
}

void forget_times()
{
    size_t count = 0;
    collected_times(&count); // what is still under way counts as before
    if (Module* m = module()) {
        m->pass_statistics.clear();
        m->graphics.timer.restart_turns();
    }
}

void thaw_scene()
{
    if (Module* m = module())
        m->view().is_frozen = false;
}

void blend_next_view()
{
    if (Module* m = module())
        m->view().blends_next = true;
}

bool read_scene(SceneContents* contents)
{
    Module* m = module();
    if (!m || !m->view().snapshot || !m->view().snapshot->world || m->graphics.is_recording())
        return false;
    *contents = read_scene_contents(*m);
    return true;
}

bool select_view(uint32_t view)
{
    Module* m = module();
    if (!m || view >= view_count || m->graphics.is_recording())
        return false;
    m->selected_view = view;
    return true;
}

bool inspect_pixel(uint32_t x, uint32_t y, InspectedSurface* surface, InspectedLight* lights, size_t capacity)
{
    Module* m = module();
    return m && m->view().snapshot && !m->graphics.is_recording()
        && m->queries().inspect_pixel({ x, y }, *surface, { lights, capacity });
}

} // namespace

const Extension& extension_table()
{
    static const Extension table { extension_version, sizeof(Extension), frame_size, capture_display, capture_radiance,
        accumulated_frames, pass_times, time_every_pass, module_info, measure_irradiance, trace_rays, thaw_scene,
        collected_times, forget_times, read_scene, select_view, inspect_pixel, blend_next_view };
    return table;
}

void print_info()
{
    const ModuleInfo info = module_info();
    const auto mib = [](uint64_t bytes) { return double(bytes) / (1 << 20); };
    engine::print("device         {}", info.device);
    engine::print("driver         {}", info.driver);
    engine::print("Vulkan         {}", info.vulkan_version);
    engine::print("trace backend  {}", info.trace_backend);
    engine::print("triangles      {} ({} moving), {:.0f} bytes each of the map's in the acceleration structure",
        info.triangles + info.dynamic_triangles, info.dynamic_triangles, info.structure_bytes_per_triangle);
    engine::print("clusters       {}", info.clusters);
    engine::print("emitters       {}, power {:.6g} {:.6g} {:.6g} (radiance x units^2 x sr)", info.emitters,
        info.emitted_power[0], info.emitted_power[1], info.emitted_power[2]);
    if (const Module* m = module()) {
        engine::print("table reads    {}", m->graphics.device.table_reads());
        const glm::uvec2 size = m->view().rendered_size;
        engine::print("rendered       {} x {} pixels, {} non-finite since the start", size.x, size.y,
            m->frame.nonfinite_pixels());
        engine::print("fireflies      {:.3f} % of the light cut off", 100 * m->frame.cut_light_share());
    }
    engine::print("light lists    {} entries", info.light_list_entries);
    engine::print("textures       {}, {:.1f} MiB", info.textures, mib(info.texture_bytes));
    engine::print("memory (MiB)   geometry {:.1f}, acceleration {:.1f}, lights {:.1f}, images {:.1f}, staging {:.1f}",
        mib(info.geometry_bytes), mib(info.acceleration_bytes), mib(info.light_bytes), mib(info.image_bytes),
        mib(info.staging_bytes));
    if (const std::optional<HeapMemory> heaps = measure_heaps())
        engine::print("heaps (MiB)    {:.1f} used, {:.1f} free", mib(heaps->used), mib(heaps->free));
    if (info.nearest_rays + info.visibility_rays > 0)
        engine::print(
            "rays           {} for the nearest hit, {} for visibility", info.nearest_rays, info.visibility_rays);
    size_t count = 0;
    const PassTime* times = pass_times(&count);
    for (size_t i = 0; i < count; i++)
        engine::print("{:22} {:8.3f} ms", times[i].name, times[i].milliseconds);
}

} // namespace vkpt
