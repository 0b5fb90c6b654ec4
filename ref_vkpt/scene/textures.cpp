// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/textures.hpp"

#include "formats/material_file.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/scene/bright_parts.hpp"
#include "ref_vkpt/scene/handles.hpp"
#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/normal_maps.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace vkpt {

namespace {

// Slots that others may take: video frames, render targets.
constexpr size_t reserved_slots = 64;
constexpr int missing_size = 64;
constexpr const char* sky_sides[6] = { "rt", "bk", "lf", "ft", "up", "dn" };

std::optional<std::vector<std::byte>> load_engine_file(const std::string& path)
{
    const std::optional<engine::FileData> file = engine::load_file(path);
    if (!file)
        return std::nullopt;
    return std::vector<std::byte>(file->bytes().begin(), file->bytes().end());
}

formats::Image make_uniform(int size, formats::Rgba8 color)
{
    return { size, size, std::vector<formats::Rgba8>(size_t(size) * size_t(size), color) };
}

bool is_flat(TextureUse use) { return use == TextureUse::image; }

bool may_have_maps(TextureUse use) { return use == TextureUse::wall || use == TextureUse::skin; }

// Of the material of a texture that is asked for by this name; those that say nothing where it has none.
const MaterialSettings& settings_of(const MaterialLibrary* library, std::string_view name, TextureUse use)
{
    static const MaterialSettings none;
    if (!library || !may_have_maps(use))
        return none;
    const MaterialSettings* found
        = library->find(formats::material_name(TextureFiles::original_paths(name, use).front()));
    return found ? *found : none;
}

// 2D is blended in display space; everything that is lit is read as linear light.
VkFormat format_of(TextureUse use)
{
    return is_flat(use) || use == TextureUse::normals ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R8G8B8A8_SRGB;
}

TextureWish make_wish(const MaterialSettings& settings)
{
    TextureWish wish;
    wish.retexturing = cvars::values().r_retexturing != 0;
    wish.doubled = cvars::values().r_scale8bittextures != 0;
    wish.file = settings.base_file;
    wish.mask = settings.mask_file;
    return wish;
}

char letter_of(TextureUse use) { return "WMSPYNE"[size_t(use)]; }

} // namespace

TextureMaps maps_of(const Texture& texture)
{
    TextureMaps maps;
    if (const Texture* normals = texture.normals) {
        maps.normals = { normals->slot, normals->packed_size };
        maps.has_metalness = normals->has_alpha;
        maps.texture_has_roughness = texture.has_alpha && !texture.has_holes;
    }
    if (const Texture* emissive = texture.emissive; emissive && emissive->brightest > 0)
        maps.emissive = { emissive->slot, emissive->packed_size };
    return maps;
}

TextureStore::TextureStore(const Gpu& gpu, Bindings& bindings, Uploader& uploader)
    : gpu_(gpu)
    , bindings_(bindings)
    , uploader_(uploader)
    , files_(load_engine_file, [](std::string_view line) { engine::print(line); })
    , capacity_(bindings.max_textures() - std::min<size_t>(bindings.max_textures() / 2, reserved_slots))
    , entries_(std::make_unique<Texture[]>(capacity_))
{
    for (size_t i = 0; i < capacity_; i++)
        free_entries_.insert(free_entries_.end(), i);
    files_.load_palette();

    white_ = take_entry();
    white_->name = "(white)";
    upload(*white_, make_uniform(1, { 255, 255, 255, 255 }));
    assert(white_->slot == 0);
    grey_ = take_entry();
    grey_->name = "(missing)";
    upload(*grey_, make_uniform(missing_size, { 128, 128, 128, 255 }));
}

TextureStore::~TextureStore() { uploader_.flush(); }

const Texture* TextureStore::find(std::string_view name, TextureUse use)
{
    Names& names = names_[size_t(use)];
    Texture* texture = nullptr;
    if (const auto known = names.find(name);
        known != names.end() && !(known->second && is_outdated(*known->second, name)))
        texture = known->second;
    else
        names.insert_or_assign(std::string(name), texture = load(name, use));
    if (texture && may_have_maps(use) && texture->registration != registration_) {
        // This map's materials may say something else.
        texture->normals = find_map(name, use, TextureUse::normals);
        texture->emissive = find_emissive(name, use);
    }
    touch(texture);
    return texture;
}

// Whether this map's materials ask for other files than those that it was made of.
bool TextureStore::is_outdated(const Texture& texture, std::string_view name) const
{
    if (texture.registration == registration_)
        return false;
    const MaterialSettings& wanted = settings_of(library_, name, texture.use);
    return texture.base_file != wanted.base_file || texture.mask_file != wanted.mask_file;
}

std::array<const Texture*, 6> TextureStore::find_sky(std::string_view name)
{
    std::array<const Texture*, 6> sides {};
    for (size_t i = 0; i < sides.size(); i++)
        sides[i] = find(fmt::format("{}{}", name, sky_sides[i]), TextureUse::sky);
    return sides;
}

const Texture* TextureStore::add_sky_side(const std::string& name, const std::function<formats::Image()>& draw)
{
    Names& names = names_[size_t(TextureUse::sky)];
    if (const auto known = names.find(name); known != names.end() && known->second) {
        touch(known->second);
        return known->second;
    }
    Texture* texture = take_entry();
    if (!texture)
        return nullptr;
    texture->name = texture->path = texture->file = name;
    texture->use = TextureUse::sky;
    upload(*texture, draw());
    texture->sun.reset();
    names.insert_or_assign(name, texture);
    return texture;
}

void TextureStore::touch(const Texture* texture)
{
    if (texture)
        entries_[size_t(texture - entries_.get())].registration = registration_;
}

const Texture* TextureStore::find_map(std::string_view name, TextureUse use, TextureUse map)
{
    const bool is_normals = map == TextureUse::normals;
    const MaterialSettings& settings = settings_of(library_, name, use);
    const std::optional<std::string>& file = is_normals ? settings.normals_file : settings.emissive_file;
    if (!file)
        return find(TextureFiles::map_path(name, use, map), map);
    if (file->empty())
        return nullptr;
    const Texture* found = find(*file, map);
    if (!found && cvars::values().r_retexturing != 0)
        engine::print("texture_{} {} of {} is missing or unusable", is_normals ? "normals" : "emissive", *file, name);
    return found;
}

const Texture* TextureStore::find_emissive(std::string_view name, TextureUse use)
{
    const Texture* found = find_map(name, use, TextureUse::emissive);
    if (found || use != TextureUse::skin) // walls shine in parts of the texture itself: FaceTexture::glows
        return found;
    const MaterialSettings& settings = settings_of(library_, name, use);
    return settings.glow_threshold > 0 ? find_bright_texels(name, settings) : nullptr;
}

const Texture* TextureStore::find_bright_texels(std::string_view skin, const MaterialSettings& settings)
{
    Names& names = names_[size_t(TextureUse::emissive)];
    const std::string name = fmt::format("{}, texels from {}", skin, settings.glow_threshold);
    if (const auto known = names.find(name); known != names.end()) {
        touch(known->second);
        return known->second;
    }
    TextureWish wish = make_wish(settings);
    wish.alpha = AlphaMeaning::other;
    std::optional<LoadedTexture> loaded = files_.load(skin, TextureUse::skin, wish);
    if (!loaded)
        return nullptr;
    loaded->image = keep_bright_texels(std::move(loaded->image), settings.glow_threshold);
    Texture described;
    described.name = name;
    described.use = TextureUse::emissive;
    return names[name] = add(std::move(described), *loaded);
}

Texture* TextureStore::load(std::string_view name, TextureUse use)
{
    Texture described;
    described.name = name;
    described.use = use;
    TextureWish wish = make_wish(settings_of(library_, name, use));
    if (may_have_maps(use)) {
        described.base_file = wish.file;
        described.mask_file = wish.mask;
        described.normals = find_map(name, use, TextureUse::normals);
        described.emissive = find_emissive(name, use);
        wish.alpha = described.normals ? AlphaMeaning::other : AlphaMeaning::opacity;
    }
    const std::optional<LoadedTexture> loaded = files_.load(name, use, wish);
    if (!loaded) {
        const std::vector<std::string> paths = TextureFiles::original_paths(name, use);
        const std::string line = fmt::format("texture {} is missing or unusable", paths.front());
        if (use == TextureUse::wall)
            engine::print("{}: shown grey", line);
        else if (use == TextureUse::sky)
            engine::print("{}: that side of the sky stays plain", line);
        else if (use != TextureUse::normals && use != TextureUse::emissive) // most textures have no such maps
            engine::print_developer(line);
        return use == TextureUse::wall ? make_missing_wall(name) : nullptr;
    }
    return add(std::move(described), *loaded);
}

// `described` has its name, use and maps. nullptr: there is no room.
Texture* TextureStore::add(Texture&& described, const LoadedTexture& loaded)
{
    Texture* texture = take_entry();
    if (!texture)
        return nullptr;
    described.registration = texture->registration;
    *texture = std::move(described);
    texture->path = loaded.path;
    texture->material = formats::material_name(loaded.path);
    texture->file = loaded.file;
    texture->has_holes = loaded.has_holes;
    const int limit = int(gpu_.device.properties.limits.maxImageDimension2D);
    try {
        if (texture->use != TextureUse::normals && (loaded.image.width > limit || loaded.image.height > limit))
            upload(*texture, shrink_texture(loaded.image, limit));
        else
            upload(*texture, loaded.image);
    } catch (...) {
        texture->image = Image(); // which has no place among the bindings yet
        release(*texture);
        throw;
    }
    texture->width = loaded.width;
    texture->height = loaded.height;
    return texture;
}

Texture* TextureStore::make_missing_wall(std::string_view name)
{
    Texture* texture = take_entry();
    if (!texture)
        return grey_;
    texture->name = name;
    texture->path = TextureFiles::original_paths(name, TextureUse::wall).front();
    texture->slot = grey_->slot;
    texture->packed_size = grey_->packed_size;
    texture->width = texture->height = missing_size;
    texture->average = grey_->average;
    texture->missing = true;
    return texture;
}

Texture* TextureStore::take_entry()
{
    if (free_entries_.empty()) {
        if (!said_full_)
            engine::print(
                "more than {} textures at once, this device's limit: the others are grey or not shown", capacity_);
        said_full_ = true;
        return nullptr;
    }
    Texture& texture = entries_[*free_entries_.begin()];
    free_entries_.erase(free_entries_.begin());
    texture = Texture();
    texture.registration = registration_;
    return &texture;
}

void TextureStore::upload_levels(Texture& texture, const formats::Image& first,
    const std::function<const formats::Image&(uint32_t level)>& next_level)
{
    ImageSettings settings;
    settings.width = uint32_t(first.width);
    settings.height = uint32_t(first.height);
    settings.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    settings.format = format_of(texture.use);
    if (!is_flat(texture.use))
        settings.mip_levels = uint32_t(std::bit_width(std::max(settings.width, settings.height)));
    texture.image = Image(gpu_, settings, texture.name);
    uploader_.fill_image(texture.image, 0, std::as_bytes(std::span(first.pixels)));
    for (uint32_t level = 1; level < settings.mip_levels; level++)
        uploader_.fill_image(texture.image, level, std::as_bytes(std::span(next_level(level).pixels)));
    upload_pending_ = true;

    texture.slot = bindings_.add_texture(texture.image);
    texture.packed_size = settings.width | settings.height << 16;
    texture.width = first.width;
    texture.height = first.height;
}

void TextureStore::measure(Texture& texture, const formats::Image& pixels) const
{
    const bool has_opacity = texture.use != TextureUse::emissive && (!texture.normals || texture.has_holes);
    const AlphaMeaning alpha = has_opacity ? AlphaMeaning::opacity : AlphaMeaning::other;
    const TextureMeasure measure = measure_texture(pixels, alpha);
    texture.average = measure.average;
    if (texture.use == TextureUse::wall || texture.use == TextureUse::emissive)
        texture.parts = find_bright_parts(pixels, alpha);
    if (texture.use == TextureUse::sky)
        texture.sun = find_painted_sun(pixels);
    if (texture.use == TextureUse::emissive && measure.brightest > 0)
        texture.glow = make_glow_map(pixels);
    texture.opaque_fraction = measure.opaque_fraction;
    texture.has_alpha = measure.has_alpha;
    texture.brightest = measure.brightest;
}

void TextureStore::upload(Texture& texture, const formats::Image& pixels)
{
    if (texture.use == TextureUse::normals) {
        const int limit = int(gpu_.device.properties.limits.maxImageDimension2D);
        const std::vector<formats::Image> levels = make_normal_levels(pixels);
        size_t first = 0;
        while (levels[first].width > limit || levels[first].height > limit)
            first++;
        upload_levels(
            texture, levels[first], [&](uint32_t level) -> const formats::Image& { return levels[first + level]; });
    } else {
        formats::Image mip = pixels;
        upload_levels(texture, pixels, [&](uint32_t) -> const formats::Image& { return mip = halve_texture(mip); });
    }
    measure(texture, pixels);
}

void TextureStore::begin_registration()
{
    registration_++;
    files_.begin_level();
    said_full_ = false;
    // What was missing may have come since: a download, another game directory.
    for (Names& names : names_)
        std::erase_if(names, [](const auto& entry) { return !entry.second || entry.second->missing; });
}

void TextureStore::end_registration()
{
    uploader_.flush();
    upload_pending_ = false;
    touch(white_);
    touch(grey_);
    const auto is_unused
        = [&](const Texture& texture) { return !is_flat(texture.use) && texture.registration != registration_; };
    for (Names& names : names_)
        std::erase_if(names, [&](const auto& entry) { return entry.second && is_unused(*entry.second); });
    for (size_t i = 0; i < capacity_; i++)
        if (entries_[i].registration != 0 && is_unused(entries_[i]))
            release(entries_[i]);
}

const Texture* TextureStore::of_handle(const void* handle) const
{
    return find_handle(handle, entries_.get(), capacity_);
}

void TextureStore::release(Texture& texture)
{
    if (texture.image)
        bindings_.remove_texture(texture.slot);
    texture = Texture();
    free_entries_.insert(size_t(&texture - entries_.get()));
}

void TextureStore::flush_if_needed()
{
    if (!upload_pending_)
        return;
    uploader_.flush();
    upload_pending_ = false;
}

std::map<uint32_t, const Texture*> TextureStore::by_slot() const
{
    std::map<uint32_t, const Texture*> slots;
    for (size_t i = 0; i < capacity_; i++)
        if (entries_[i].registration != 0)
            slots.emplace(entries_[i].slot, &entries_[i]); // the first, where several share one
    return slots;
}

size_t TextureStore::count() const
{
    return size_t(std::count_if(entries_.get(), entries_.get() + capacity_,
        [](const Texture& texture) { return texture.registration != 0 && !texture.path.empty(); }));
}

void TextureStore::print_list() const
{
    size_t count = 0;
    uint64_t texels = 0;
    for (size_t i = 0; i < capacity_; i++) {
        const Texture& texture = entries_[i];
        if (texture.registration == 0 || texture.path.empty())
            continue;
        count++;
        texels += uint64_t(texture.image.width()) * texture.image.height() * (texture.image ? 1 : 0);
        engine::print("{} {:4} x {:4} {} {}{}{}", letter_of(texture.use), texture.width, texture.height,
            texture.has_alpha ? "RGBA" : "RGB ", texture.path,
            texture.missing                    ? " (missing)"
                : texture.file != texture.path ? " <- " + texture.file
                                               : "",
            texture.registration == registration_ ? " *" : "");
    }
    engine::print("{} textures (W wall, M model, S sprite, P 2D, Y sky, N normals, E emission; * in use), {:.1f} "
                  "million texels, {:.0f} MiB",
        count, double(texels) / 1e6, double(gpu_.memory.bytes_in_use(MemoryKind::textures)) / double(1 << 20));
}

} // namespace vkpt
