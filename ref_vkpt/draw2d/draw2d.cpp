// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/draw2d/draw2d.hpp"

#include "shaders/shared/frame.h"

#include <algorithm>
#include <cmath>

namespace vkpt {

namespace {

constexpr uint32_t opaque_white = 0xffffffff;
constexpr float fade_alpha = 0.6f; // as Yamagi's OpenGL 3 renderer
constexpr float tile_size = 64;
constexpr int character_pixels = 8;
constexpr int characters_per_row = 16;

uint32_t pack_color(float r, float g, float b, float a)
{
    const auto byte = [](float value) { return uint32_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f)); };
    return byte(r) | byte(g) << 8 | byte(b) << 16 | byte(a) << 24;
}

uint32_t pack_opaque(uint32_t r, uint32_t g, uint32_t b) { return r | g << 8 | b << 16 | 0xff000000; }

glm::vec2 low_corner(const Rectangle& place) { return { float(place.x), float(place.y) }; }

// In floats: the engine's numbers may be anything, and their sum overflow.
glm::vec2 high_corner(const Rectangle& place)
{
    return low_corner(place) + glm::vec2(float(place.width), float(place.height));
}

bool is_empty(const Rectangle& place) { return place.width <= 0 || place.height <= 0; }

} // namespace

void Draw2d::begin_frame(uint32_t frame_slot, const Filtering& filtering, const Brightness& brightness)
{
    filtering_ = filtering;
    brightness_ = brightness;
    frame_ = frame_slot;
    FrameMemory& frame = frames_[frame_];
    frame.used = 0;
    frame.retired.clear();
    for (const RawImage& image : frame.retired_images)
        bindings_.remove_texture(image.slot);
    frame.retired_images.clear();
    // What a frame that broke off has left.
    quads_.clear();
    raw_copies_.clear();
    raw_images_used_ = 0;
}

// ---- what is drawn

uint32_t Draw2d::choose_sampler(const Texture& texture) const
{
    const auto is_listed = [&](const std::string& list) {
        return !texture.path.empty() && list.find(texture.path) != std::string::npos;
    };
    const bool nearest
        = filtering_.unfiltered_images ? !is_listed(filtering_.always_filtered) : is_listed(filtering_.never_filtered);
    return nearest ? shared::SAMPLER_CLAMP_NEAREST : shared::SAMPLER_CLAMP;
}

void Draw2d::add_quad(const Texture& texture, glm::vec2 low, glm::vec2 high, uint32_t color)
{
    const bool opaque = !texture.has_alpha && color >> 24 == 255;
    quads_.push_back({ low, high, { 0, 0 }, { 1, 1 }, color, texture.slot, choose_sampler(texture),
        opaque ? shared::QUAD_OPAQUE : 0 });
}

void Draw2d::add_plain_quad(glm::vec2 low, glm::vec2 high, uint32_t color)
{
    add_quad(textures_.white(), low, high, color);
    quads_.back().flags |= shared::QUAD_PLAIN;
}

void Draw2d::draw_pic(const Texture& texture, int x, int y, float scale, const float* tint_rgb)
{
    const glm::vec2 low(x, y);
    const glm::vec2 size = glm::vec2(texture.width, texture.height) * scale;
    add_quad(texture, low, low + size, tint_rgb ? pack_color(tint_rgb[0], tint_rgb[1], tint_rgb[2], 1) : opaque_white);
}

void Draw2d::draw_stretched(const Texture& texture, const Rectangle& place)
{
    if (!is_empty(place))
        add_quad(texture, low_corner(place), high_corner(place));
}

void Draw2d::draw_character(int x, int y, int code, float scale)
{
    constexpr int space = 32; // in both halves of the font
    code &= 255;
    const float size = character_pixels * scale;
    if ((code & 127) == space || float(y) <= -size)
        return;
    const Texture* font = textures_.find("conchars", TextureUse::image);
    if (!font)
        return;
    const glm::vec2 low(x, y);
    add_quad(*font, low, low + size);
    constexpr float step = 1.0f / characters_per_row;
    shared::Quad& quad = quads_.back();
    quad.uv_min = glm::vec2(code % characters_per_row, code / characters_per_row) * step;
    quad.uv_max = quad.uv_min + step;
}

void Draw2d::draw_tiled(const Texture& texture, const Rectangle& place)
{
    if (is_empty(place))
        return;
    add_quad(texture, low_corner(place), high_corner(place));
    shared::Quad& quad = quads_.back();
    quad.uv_min = quad.corner_min / tile_size;
    quad.uv_max = quad.corner_max / tile_size;
    quad.sampler_index
        = quad.sampler_index == shared::SAMPLER_CLAMP ? shared::SAMPLER_REPEAT : shared::SAMPLER_REPEAT_NEAREST;
}

void Draw2d::draw_fill(const Rectangle& place, int palette_index)
{
    if (is_empty(place))
        return;
    const formats::Rgba8 color = textures_.palette()[size_t(palette_index & 255)];
    add_plain_quad(low_corner(place), high_corner(place), pack_opaque(color.r, color.g, color.b));
}

void Draw2d::draw_fade()
{
    add_plain_quad({ 0, 0 }, { float(size_.width), float(size_.height) }, pack_color(0, 0, 0, fade_alpha));
}

void Draw2d::draw_shade(const Rectangle& place)
{
    if (!is_empty(place))
        add_plain_quad(low_corner(place), high_corner(place), pack_color(0, 0, 0, fade_alpha));
}

void Draw2d::set_palette(const uint8_t* rgb)
{
    if (!rgb) {
        video_palette_.reset();
        return;
    }
    video_palette_.emplace();
    for (size_t i = 0; i < video_palette_->size(); i++)
        (*video_palette_)[i] = pack_opaque(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]);
}

void Draw2d::draw_raw(const Rectangle& place, int columns, int rows, const uint8_t* pixels, int bits)
{
    const int limit = int(gpu_.device.properties.limits.maxImageDimension2D);
    if (is_empty(place) || !pixels || columns <= 0 || rows <= 0 || columns > limit || rows > limit)
        return;
    const size_t count = size_t(columns) * size_t(rows);
    RawCopy copy { prepare_raw_image(columns, rows),
        Buffer(gpu_, count * sizeof(uint32_t), BufferHome::upload, MemoryKind::staging, "video frame") };
    auto* target = reinterpret_cast<uint32_t*>(copy.staging.mapped());
    if (bits == 32) {
        for (size_t i = 0; i < count; i++)
            target[i] = pack_opaque(pixels[4 * i], pixels[4 * i + 1], pixels[4 * i + 2]);
    } else {
        std::array<uint32_t, 256> colors;
        for (size_t i = 0; i < colors.size(); i++) {
            const formats::Rgba8 own = textures_.palette()[i];
            colors[i] = video_palette_ ? (*video_palette_)[i] : pack_opaque(own.r, own.g, own.b);
        }
        for (size_t i = 0; i < count; i++)
            target[i] = colors[pixels[i]];
    }
    add_quad(textures_.white(), low_corner(place), high_corner(place));
    shared::Quad& quad = quads_.back();
    quad.texture_slot = raw_images_[copy.image].slot;
    quad.sampler_index = filtering_.unfiltered_videos ? shared::SAMPLER_CLAMP_NEAREST : shared::SAMPLER_CLAMP;
    raw_copies_.push_back(std::move(copy));
}

// Each video image of a frame has one of its own on the device, kept for the next frame's.
size_t Draw2d::prepare_raw_image(int columns, int rows)
{
    const size_t index = raw_images_used_++;
    if (index == raw_images_.size())
        raw_images_.emplace_back();
    RawImage& image = raw_images_[index];
    if (image.image && image.image.width() == uint32_t(columns) && image.image.height() == uint32_t(rows))
        return index;
    if (image.image)
        frames_[frame_].retired_images.push_back(std::move(image));
    ImageSettings settings;
    settings.width = uint32_t(columns);
    settings.height = uint32_t(rows);
    settings.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    image = RawImage { Image(gpu_, settings, "video") };
    image.slot = bindings_.add_texture(image.image);
    return index;
}

} // namespace vkpt
