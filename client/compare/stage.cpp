// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/stage.hpp"

#include "client/host/errors.hpp"
#include "common/hash.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>
#include <string_view>

namespace vkpt::client {

namespace {

// Anti-aliasing follows the frame that is captured, and blurs what the samplers did.
constexpr std::pair<const char*, const char*> fixed_cvars[] = { { "flt_taa", "off" } };

HostOptions make_host(const StageOptions& options)
{
    HostOptions host = make_host_options(options.module);
    host.width = options.size.width;
    host.height = options.size.height;
    for (const auto& [name, value] : fixed_cvars)
        host.cvars.insert(host.cvars.begin(), { name, value });
    return host;
}

uint64_t hash_text(std::string_view text, uint64_t hash) { return hash_bytes(std::as_bytes(std::span(text)), hash); }

uint64_t hash_file(const std::filesystem::path& path, uint64_t hash)
{
    std::ifstream stream(path, std::ios::binary);
    return hash_text(std::string { std::istreambuf_iterator<char>(stream), {} }, hash);
}

} // namespace

Stage::Stage(const StageOptions& options, const std::string& scene)
    : files_(options.base_folder, options.game)
    , source_(open_frame_source(files_, scene))
    , host_(make_host(options), &files_)
    , scene_(scene)
    , settings_(fmt::format("{}", fmt::join(options.module.settings, " ")))
{
    source_->register_with(host_);
    host_.extension().time_every_pass();
    info_ = host_.extension().info();
}

uint64_t Stage::content_hash() const
{
    uint64_t hash = hash_file(host_.module_path(), hash_start);
    const std::filesystem::path file(scene_.substr(0, scene_.rfind('@')));
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored))
        hash = hash_file(file, hash);
    const uint64_t files = files_.content_hash();
    const Camera view = camera();
    return hash_text(fmt::format("{} {:016x} {} {} {} {} {} {} {} {}x{} {}", scene_, files, frame(), view.position.x,
                         view.position.y, view.position.z, view.pitch, view.yaw, settings_, host_.width(),
                         host_.height(), host_.extension().version),
        hash);
}

void Stage::set(const Variant& variant)
{
    set("pt_light_sampler", variant.sampler);
    if (variant.subset)
        set("pt_light_subset", std::to_string(*variant.subset));
    set("pt_noise", variant.noise);
    set("flt_denoiser", variant.denoiser);
}

void Stage::begin_averaged(const Variant& variant, int seed)
{
    set(variant);
    set("pt_accumulate", "1");
    set("pt_seed", std::to_string(seed));
}

void Stage::begin_live(const Variant& variant)
{
    begin_averaged(variant, 1);
    draw(frame()); // filters forget before an averaged view
    set("pt_accumulate", "0");
    set("pt_seed", "0"); // new numbers each frame
}

FrameTime Stage::draw(int frame)
{
    source_->draw(host_, frame);
    size_t count = 0;
    const PassTime* passes = host_.extension().pass_times(&count);
    FrameTime time;
    for (size_t i = 0; i < count; i++) {
        const std::string_view name = passes[i].name;
        time.all += passes[i].milliseconds;
        if (name == "direct_light" || name == "indirect_light")
            time.light += passes[i].milliseconds;
    }
    return time;
}

analysis::LinearImage Stage::capture() const
{
    const ImageSize size = host_.extension().frame_size();
    analysis::LinearImage image = analysis::make_image(size.width, size.height);
    if (!host_.extension().capture_radiance(image.rgb.data()))
        throw Failure(fmt::format("{}: the module has no finished 3D view to capture", scene_));
    for (const float value : image.rgb)
        if (!std::isfinite(value))
            throw Failure(fmt::format(
                "{}: the module's picture has values that are not finite: please report this scene", scene_));
    return image;
}

} // namespace vkpt::client
