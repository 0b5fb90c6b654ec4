// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/map_compiler/texture_folder.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace vkpt::tests {

namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::vector<std::byte>& bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

} // namespace

TextureFolder::TextureFolder()
{
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() / ("vkpt_map_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    formats::IndexedImage colormap;
    colormap.width = colormap.height = 16;
    colormap.pixels.resize(256);
    colormap.palette[0] = { 0, 0, 0, 255 };
    colormap.palette[1] = { 255, 255, 255, 255 };
    colormap.palette[2] = { 137, 188, 188, 255 };
    write(root_ / "pics" / "colormap.pcx", formats::write_pcx(colormap));
    fs::create_directories(textures());
}

TextureFolder::~TextureFolder()
{
    std::error_code error;
    fs::remove_all(root_, error);
}

void TextureFolder::add(const formats::WallInfo& info, uint8_t index) const
{
    formats::IndexedImage image;
    image.width = image.height = 16;
    image.pixels.assign(256, index);
    formats::WallInfo sized = info;
    sized.width = sized.height = 16;
    write(textures() / (info.name + ".wal"), formats::write_wal(image, sized));
}

} // namespace vkpt::tests
