// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/compare/reference.hpp"

#include "shaders/shared/light_sampler.h"

#include "client/host/errors.hpp"
#include "client/host/name_list.hpp"
#include "client/host/output_file.hpp"
#include "client/host/private_folder.hpp"
#include "common/hash.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace vkpt::client {

namespace fs = std::filesystem;
using analysis::LinearImage;

namespace {

// Independent parts, each from a seed of its own, that no compared run has.
constexpr int batch_count = 16, first_seed = 1'000'000;
using Batches = std::array<LinearImage, batch_count>;

// In memory and in the cache: what Reference is made of.
struct Converged {
    std::array<LinearImage, 2> halves; // sums of eight batches' averages
    std::vector<double> batch_means; // luminance
    std::vector<std::vector<double>> batch_blocks; // block_differences to black: mean luminance by 1
};

std::string choose_sampler(const std::string& wanted, const ModuleInfo& module)
{
    std::string first;
    for (const std::string& known : list_names(module.light_samplers)) {
        if (known == wanted || (wanted.empty() && known == "subset_mis"))
            return known;
        if (first.empty() && !(find_sampler_traits(module, known) & shared::SAMPLER_BIASED))
            first = known;
    }
    if (!wanted.empty())
        throw WrongUse(fmt::format("--reference-sampler {}: there is no such sampler; `vkpt info` lists them", wanted));
    return first;
}

// One part: the average of `samples` samples.
LinearImage draw_batch(Stage& stage, int frame, PixelPart part, int samples, const std::function<void()>& on_sample)
{
    LinearImage sum;
    for (int sample = 0; sample < samples; sample++) {
        stage.draw(frame);
        if (part == PixelPart::centre)
            add_image(sum, stage.capture());
        on_sample();
    }
    if (part == PixelPart::whole)
        return stage.capture(); // the module averages
    scale_image(sum, 1.0f / float(samples));
    return sum;
}

Converged draw_converged(Stage& stage, int frame, PixelPart part, int samples, const Variant& variant,
    const std::function<void()>& on_sample)
{
    Converged result;
    for (int batch = 0; batch < batch_count; batch++) {
        if (part == PixelPart::whole)
            stage.begin_averaged(variant, first_seed + batch);
        else
            stage.begin_live(variant);
        const LinearImage average = draw_batch(stage, frame, part, samples / batch_count, on_sample);
        add_image(result.halves[size_t(batch % 2)], average);
        result.batch_means.push_back(mean_luminance(average));
        const LinearImage black = analysis::make_image(average.width, average.height);
        result.batch_blocks.push_back(block_differences(black, average, block_side));
    }
    return result;
}

Reference assemble(const Converged& converged)
{
    Reference reference;
    std::array<LinearImage, 2> halves = converged.halves;
    for (LinearImage& half : halves)
        scale_image(half, 2.0f / batch_count);
    reference.image = halves[0];
    add_image(reference.image, halves[1]);
    scale_image(reference.image, 0.5f);
    reference.rmse = analysis::measure_error(halves[0], halves[1]).rmse / 2;
    const analysis::Estimate mean = analysis::estimate_mean(converged.batch_means);
    const double scale = mean.mean > 0 ? mean.mean : 1;
    reference.mean_interval = mean.interval / scale;
    for (size_t block = 0; block < converged.batch_blocks[0].size(); block++) {
        double sum = 0, squares = 0;
        for (const std::vector<double>& batch : converged.batch_blocks) {
            sum += batch[block] / scale / batch_count;
            squares += batch[block] * batch[block] / (scale * scale) / batch_count;
        }
        reference.block_variances.push_back(std::max(squares - sum * sum, 0.0) / (batch_count - 1));
    }
    return reference;
}

// ---- the cache: one file a picture; the hash of its content comes first

constexpr std::string_view cache_magic = "vkpt reference 1\n";

template <class Value> void append(std::string& text, const std::vector<Value>& values)
{
    text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

std::string pack(const Converged& converged)
{
    std::string text;
    for (const LinearImage& half : converged.halves)
        append(text, half.rgb);
    append(text, converged.batch_means);
    for (const std::vector<double>& blocks : converged.batch_blocks)
        append(text, blocks);
    return text;
}

uint64_t hash_text(const std::string& text) { return hash_bytes(std::as_bytes(std::span(text))); }

std::optional<Converged> unpack(const std::string& text, int width, int height)
{
    Converged result;
    result.halves.fill(analysis::make_image(width, height));
    const size_t blocks = block_differences(result.halves[0], result.halves[0], block_side).size();
    result.batch_means.resize(batch_count);
    result.batch_blocks.assign(batch_count, std::vector<double>(blocks));
    size_t at = 0;
    const auto take = [&](auto& values) {
        const size_t bytes = values.size() * sizeof(values[0]);
        if (at + bytes <= text.size())
            std::memcpy(values.data(), text.data() + at, bytes);
        at += bytes;
    };
    for (LinearImage& half : result.halves)
        take(half.rgb);
    take(result.batch_means);
    for (std::vector<double>& batch : result.batch_blocks)
        take(batch);
    return at == text.size() ? std::optional(result) : std::nullopt;
}

// Nothing: not there, or damaged; it is made anew then.
std::optional<Converged> read_cache(const fs::path& path, int width, int height)
{
    std::ifstream stream(path, std::ios::binary);
    const std::string text { std::istreambuf_iterator<char>(stream), {} };
    uint64_t hash = 0;
    if (!text.starts_with(cache_magic) || text.size() < cache_magic.size() + sizeof hash)
        return std::nullopt;
    std::memcpy(&hash, text.data() + cache_magic.size(), sizeof hash);
    const std::string packed = text.substr(cache_magic.size() + sizeof hash);
    return hash_text(packed) == hash ? unpack(packed, width, height) : std::nullopt;
}

// A cache that cannot be written costs time only.
void write_cache(const fs::path& path, const Converged& converged)
try {
    const std::string packed = pack(converged);
    const uint64_t hash = hash_text(packed);
    std::string text(cache_magic);
    text.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    text += packed;
    OutputFile file(path);
    file.write(std::as_bytes(std::span(text)));
    file.commit();
} catch (const Failure& failure) {
    fmt::print(stderr, "vkpt: the reference is not cached: {}\n", failure.what());
}

} // namespace

fs::path find_reference_folder()
{
    const PrivateFolder cache = open_cache_folder();
    const PrivateFolder folder = cache.path.empty() ? cache : open_private_folder(cache.path / "references");
    if (folder.path.empty())
        fmt::print(stderr, "vkpt: references are not cached: {}\n", folder.problem);
    return folder.path;
}

Reference make_reference(
    Stage& stage, int frame, PixelPart part, const ReferenceOptions& options, const std::function<void()>& on_sample)
{
    const std::string sampler = choose_sampler(options.sampler, stage.info());
    const int samples = std::max(options.samples / batch_count, 1) * batch_count;
    const bool has_subset = find_sampler_traits(stage.info(), sampler) & shared::SAMPLER_USES_SUBSET;
    const Variant variant = make_variant(sampler, has_subset ? std::optional(8) : std::nullopt);
    // The first picture shows its size, and loads what a frame asks for only when it is drawn.
    stage.begin_averaged(variant, 1);
    stage.draw(frame);
    const LinearImage first = stage.capture();
    const std::string key = fmt::format("{:016x} {} {} {} {} {}", stage.content_hash(), frame,
        part == PixelPart::whole ? "whole" : "centre", sampler, samples, batch_count);
    const fs::path path = options.cache_folder / fmt::format("{:016x}.reference", hash_text(key));
    const bool has_cache = !options.cache_folder.empty();
    std::optional<Converged> converged = has_cache ? read_cache(path, first.width, first.height) : std::nullopt;
    const bool was_cached = converged.has_value();
    if (!converged) {
        converged = draw_converged(stage, frame, part, samples, variant, on_sample);
        if (has_cache)
            write_cache(path, *converged);
    }
    Reference reference = assemble(*converged);
    reference.samples = samples;
    reference.sampler = sampler;
    reference.was_cached = was_cached;
    return reference;
}

} // namespace vkpt::client
