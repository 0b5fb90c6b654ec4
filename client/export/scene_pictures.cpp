// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/export/scene_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/color_space.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace vkpt::client {

namespace {

// Where a direction meets the cube: which side, and the place in its picture, 0..1 from the left top. The sides are
// +x, -x, +y, -y, +z, -z.
struct CubePlace {
    size_t side;
    glm::dvec2 uv;
};

CubePlace meet_cube(glm::dvec3 d)
{
    const glm::dvec3 size = glm::abs(d);
    const auto place = [](size_t side, double x, double y, double length) {
        return CubePlace { side, glm::dvec2(x, y) / length * 0.5 + 0.5 };
    };
    if (size.x >= size.y && size.x >= size.z)
        return d.x > 0 ? place(0, -d.y, -d.z, size.x) : place(1, d.y, -d.z, size.x);
    if (size.y >= size.z)
        return d.y > 0 ? place(2, d.x, -d.z, size.y) : place(3, -d.x, -d.z, size.y);
    return d.z > 0 ? place(4, -d.y, d.x, size.z) : place(5, -d.y, -d.x, size.z);
}

// A picture as linear light, read between four texels that end at its edges.
class LinearPicture {
public:
    explicit LinearPicture(const formats::Image* image)
    {
        if (!image)
            return;
        width_ = image->width;
        height_ = image->height;
        texels_.clear();
        for (const formats::Rgba8& pixel : image->pixels)
            texels_.push_back(glm::convertSRGBToLinear(glm::dvec3(pixel.r, pixel.g, pixel.b) / 255.0));
    }
    glm::dvec3 at(glm::dvec2 uv) const
    {
        const glm::dvec2 place = uv * glm::dvec2(width_, height_) - 0.5;
        const glm::dvec2 floor = glm::floor(place), f = place - floor;
        const int x = int(floor.x), y = int(floor.y);
        return glm::mix(
            glm::mix(texel(x, y), texel(x + 1, y), f.x), glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x), f.y);
    }

private:
    glm::dvec3 texel(int x, int y) const
    {
        return texels_[size_t(std::clamp(y, 0, height_ - 1)) * size_t(width_) + size_t(std::clamp(x, 0, width_ - 1))];
    }
    int width_ = 1, height_ = 1;
    std::vector<glm::dvec3> texels_ { glm::dvec3(1) };
};

// "textures/e1/lamp.wal" as the name of a file beside others.
std::string flat_name(const std::string& picture)
{
    std::string name = picture;
    std::ranges::replace_if(
        name, [](char c) { return !(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.'); },
        '_');
    return name;
}

} // namespace

ScenePictures::ScenePictures(const FileSystem& files)
    : files_(files)
{
    try {
        if (const auto bytes = files_.read("pics/colormap.pcx"))
            palette_ = formats::read_pcx_palette(*bytes, "pics/colormap.pcx");
    } catch (const formats::FormatError& error) {
        notes_.emplace_back(error.what());
    }
}

const formats::Image* ScenePictures::find(const std::string& picture)
{
    const auto [entry, is_new] = images_.try_emplace(picture);
    if (is_new) {
        try {
            if (const auto bytes = files_.read(picture))
                entry->second = formats::read_image(*bytes, picture, palette_);
            else
                notes_.push_back(fmt::format("{}: not found; its average colour is used instead", picture));
        } catch (const formats::FormatError& error) {
            notes_.push_back(fmt::format("{}; its average colour is used instead", error.what()));
        }
    }
    return entry->second.pixels.empty() ? nullptr : &entry->second;
}

void ScenePictures::add(const SceneContents& scene)
{
    for (size_t i = 0; i < scene.material_count; i++) {
        const std::string picture = scene.materials[i].texture;
        if (picture.empty() || names_.contains(picture))
            continue;
        const formats::Image* image = find(picture);
        if (!image)
            continue;
        const std::string name = fmt::format("textures/{:03}_{}.png", written_.size(), flat_name(picture));
        names_.emplace(picture, name);
        written_.push_back({ name, *image });
    }
}

std::string ScenePictures::name_of(const std::string& picture) const
{
    const auto found = names_.find(picture);
    return found == names_.end() ? std::string() : found->second;
}

analysis::LinearImage ScenePictures::sky(const SceneSky& sky, int width)
{
    using std::numbers::pi;
    if (std::ranges::all_of(sky.textures, [](const char* picture) { return *picture == 0; }))
        return {};
    std::vector<LinearPicture> sides;
    for (const char* picture : sky.textures)
        sides.emplace_back(*picture ? find(picture) : nullptr);
    analysis::LinearImage result = analysis::make_image(width, width / 2);
    float* out = result.rgb.data();
    for (int y = 0; y < result.height; y++)
        for (int x = 0; x < result.width; x++) {
            const double around = (0.5 - (x + 0.5) / result.width) * 2 * pi, down = (y + 0.5) / result.height * pi;
            const CubePlace place
                = meet_cube({ std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down) });
            const glm::dvec3 colour = sides[place.side].at(place.uv);
            for (int channel = 0; channel < 3; channel++)
                *out++ = float(colour[channel]);
        }
    return result;
}

} // namespace vkpt::client
