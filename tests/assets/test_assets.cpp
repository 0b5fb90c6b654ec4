// SPDX-License-Identifier: GPL-2.0-or-later
// The game data that the build made: everything the game asks for exists and reads back.
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "formats/image.hpp"
#include "formats/model.hpp"
#include "tools/asset_generator/guns.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <set>
#include <unistd.h>

namespace fs = std::filesystem;
using namespace formats;

namespace {

std::vector<std::byte> load(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    EXPECT_TRUE(stream) << path;
    const std::vector<char> text { std::istreambuf_iterator<char>(stream), {} };
    std::vector<std::byte> bytes(text.size());
    std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return std::byte(c); });
    return bytes;
}

std::vector<std::string> lines_of(const fs::path& path)
{
    std::ifstream stream(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        if (!line.empty() && line[0] != '#')
            lines.push_back(line);
    return lines;
}

// A folder of game data.
class Data {
public:
    explicit Data(fs::path path)
        : path_(std::move(path))
    {
    }
    const fs::path& path() const { return path_; }
    std::vector<fs::path> files(std::string_view ending) const
    {
        std::vector<fs::path> found;
        for (const auto& entry : fs::recursive_directory_iterator(path_))
            if (entry.is_regular_file() && (ending.empty() || entry.path().extension() == ending))
                found.push_back(entry.path());
        std::sort(found.begin(), found.end());
        return found;
    }

private:
    fs::path path_;
};

// What the build has made.
const Data& game()
{
    static const Data data(VKPT_GAME_DATA);
    return data;
}

Image read_any(const fs::path& path) { return read_image(load(path), path.string(), vkpt::tools::game_palette()); }

// Mean difference between two neighbouring columns (or rows).
double seam(const Image& image, bool columns, int a, int b)
{
    double sum = 0;
    const int length = columns ? image.height : image.width;
    for (int i = 0; i < length; i++) {
        const Rgba8& p = columns ? image.at(a, i) : image.at(i, a);
        const Rgba8& q = columns ? image.at(b, i) : image.at(i, b);
        sum += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b);
    }
    return sum / length;
}

std::set<std::string> textures_of_map(const fs::path& path)
{
    std::set<std::string> names;
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
        const size_t end = line.rfind(')');
        if (line.empty() || line[0] != '(' || end == std::string::npos)
            continue;
        const size_t from = line.find_first_not_of(' ', end + 1);
        names.insert(line.substr(from, line.find(' ', from) - from));
    }
    return names;
}

} // namespace

TEST(Assets, PaletteIsWellSpread)
{
    const Palette palette = read_pcx_palette(load(game().path() / "pics/colormap.pcx"), "colormap.pcx");
    EXPECT_EQ(palette, vkpt::tools::game_palette());
    // The farthest that any colour of a coarse cube is from the palette, in 0..255 units per channel.
    double worst = 0;
    for (int r = 0; r <= 255; r += 51)
        for (int g = 0; g <= 255; g += 51)
            for (int b = 0; b <= 255; b += 51) {
                double nearest = 1e9;
                for (const Rgba8& c : palette)
                    nearest = std::min(nearest, std::hypot(c.r - r, c.g - g, c.b - b));
                worst = std::max(worst, nearest);
            }
    EXPECT_LT(worst, 130);
}

TEST(Assets, RequiredPicturesExistAndShowSomething)
{
    const auto names = lines_of(fs::path(VKPT_BASEQ2_SOURCES) / "required_pictures.txt");
    ASSERT_GT(names.size(), 100u);
    for (const std::string& name : names) {
        const fs::path path = game().path() / "pics" / (name + ".pcx");
        ASSERT_TRUE(fs::exists(path)) << path;
        const Image image = read_any(path);
        std::set<std::array<int, 3>> colours;
        for (const Rgba8& p : image.pixels)
            if (p.a > 0)
                colours.insert({ p.r, p.g, p.b });
        EXPECT_GE(colours.size(), 2u) << path << " is blank";
    }
}

TEST(Assets, RequiredModelsSkinsAndSpritesExist)
{
    const auto names = lines_of(fs::path(VKPT_BASEQ2_SOURCES) / "required_models.txt");
    ASSERT_GT(names.size(), 90u);
    for (const std::string& name : names)
        EXPECT_TRUE(fs::exists(game().path() / name)) << name;
}

TEST(Assets, EveryPictureReadsBack)
{
    for (const char* ending : { ".pcx", ".png", ".tga", ".wal" }) {
        const auto files = game().files(ending);
        EXPECT_FALSE(files.empty()) << ending;
        for (const fs::path& path : files) {
            const Image image = read_any(path);
            EXPECT_GT(image.width, 0) << path;
            EXPECT_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height)) << path;
        }
    }
}

TEST(Assets, HighResolutionTwinsKeepTheirShape)
{
    for (const fs::path& path : game().files(".png")) {
        fs::path small = path;
        small.replace_extension(path.string().find("textures") != std::string::npos ? ".wal" : ".pcx");
        ASSERT_TRUE(fs::exists(small)) << small;
        const Image twin = read_any(path), original = read_any(small);
        EXPECT_EQ(twin.width * original.height, twin.height * original.width) << path;
        EXPECT_GT(twin.width, original.width) << path;
    }
}

TEST(Assets, EveryModelReadsBackWithItsSkins)
{
    for (const fs::path& path : game().files(".md2")) {
        const Md2Model model = read_md2(load(path), path.string());
        ASSERT_FALSE(model.frames.empty()) << path;
        EXPECT_GT(model.triangle_count(), 0u) << path;
        EXPECT_LE(model.triangle_count(), 1200u) << path;
        ASSERT_FALSE(model.skins.empty()) << path;
        for (const std::string& skin : model.skins)
            EXPECT_TRUE(fs::exists(game().path() / skin)) << path << " wants " << skin;
    }
}

// Signed volume of a mesh: positive when triangles face outwards.
TEST(Assets, ModelsAreNotInsideOut)
{
    for (const fs::path& path : game().files(".md2")) {
        const Md2Model model = read_md2(load(path), path.string());
        double volume = 0;
        const auto& positions = model.frames.front().positions;
        for (size_t i = 0; i + 2 < model.indices.size(); i += 3)
            volume += glm::dot(positions[model.indices[i]],
                glm::cross(positions[model.indices[i + 1]], positions[model.indices[i + 2]]));
        EXPECT_GT(volume, 0) << path;
    }
}

TEST(Assets, FrameCountsAreTheGamesOwn)
{
    for (const vkpt::tools::Gun& gun : vkpt::tools::guns()) {
        const std::string path = std::string("models/weapons/") + gun.view + "/tris.md2";
        EXPECT_EQ(read_md2(load(game().path() / path), path).frames.size(), size_t(gun.lowered) + 1) << path;
        const std::string held = std::string("players/male/") + gun.held + ".md2";
        EXPECT_EQ(read_md2(load(game().path() / held), held).frames.size(), 198u);
    }
    const std::string figure = "players/male/tris.md2";
    const Md2Model model = read_md2(load(game().path() / figure), figure);
    ASSERT_EQ(model.frames.size(), 198u);
    // Standing feet touch the floor of the player's box; a dead body lies low.
    EXPECT_NEAR(model.frames[0].mins.z, -24, 1.5);
    EXPECT_GT(model.frames[0].maxs.z, 24);
    EXPECT_LT(model.frames[183].maxs.z, 5);
}

TEST(Assets, SpritesFindTheirPictures)
{
    const auto files = game().files(".sp2");
    ASSERT_EQ(files.size(), 3u);
    for (const fs::path& path : files)
        for (const Sp2Sprite::Frame& frame : read_sp2(load(path), path.string()).frames) {
            const Image image = read_any(game().path() / frame.picture);
            EXPECT_EQ(image.width, frame.width);
            EXPECT_EQ(image.height, frame.height);
        }
}

TEST(Assets, TexturesTile)
{
    for (const fs::path& path : game().files(".wal")) {
        const Image image = read_any(path);
        for (const bool columns : { true, false }) {
            const int size = columns ? image.width : image.height;
            double inside = 0;
            for (int i = 0; i + 1 < size; i++)
                inside = std::max(inside, seam(image, columns, i, i + 1));
            EXPECT_LE(seam(image, columns, size - 1, 0), inside * 1.05 + 3) << path << (columns ? " u" : " v");
        }
    }
}

TEST(Assets, TexturesSayWhatTheyAre)
{
    std::map<std::string, WallInfo> walls;
    for (const fs::path& path : game().files(".wal")) {
        const WallInfo info = read_wal_info(load(path), path.string());
        fs::path expected = fs::relative(path, game().path() / "textures");
        EXPECT_EQ(info.name, expected.replace_extension().generic_string());
        EXPECT_LT(info.name.size(), 32u);
        walls[info.name] = info;
    }
    for (const auto& [name, info] : walls) {
        const bool emits = name.find("/light_") != std::string::npos || name.find("/strip_") != std::string::npos
            || name.find("/lamp_") != std::string::npos || name.find("/blink") != std::string::npos
            || name.find("/screen") != std::string::npos || name == "vkpt/lava";
        if (emits) {
            EXPECT_TRUE(info.flags & SURF_LIGHT) << name;
            EXPECT_GT(info.value, 0) << name;
        }
        EXPECT_TRUE(info.value > 0 || !(info.flags & SURF_LIGHT)) << name;
        // Animation chains lead back to where they began.
        std::string at = name;
        for (int steps = 0; !info.next_animation.empty(); steps++) {
            ASSERT_LT(steps, 16) << name;
            ASSERT_TRUE(walls.count(at)) << at;
            at = walls[at].next_animation;
            if (at == name)
                break;
        }
    }
    EXPECT_TRUE(walls.at("vkpt/water").flags & SURF_WARP);
    EXPECT_EQ(walls.at("vkpt/water").contents, uint32_t(CONTENTS_WATER));
    EXPECT_TRUE(walls.at("vkpt/glass").flags & (SURF_TRANS33 | SURF_TRANS66));
    EXPECT_TRUE(walls.at("vkpt/sky").flags & SURF_SKY);
    EXPECT_TRUE(walls.at("vkpt/clip").contents & CONTENTS_PLAYERCLIP);
    EXPECT_EQ(walls.at("vkpt/blink1").next_animation, "vkpt/blink2");
}

TEST(Assets, WallsHaveAPlausibleAlbedo)
{
    for (const fs::path& path : game().files(".wal")) {
        if (read_wal_info(load(path), path.string()).flags != 0)
            continue; // light, liquids, glass and tool textures
        const Image image = read_any(path);
        double sum = 0;
        for (const Rgba8& p : image.pixels)
            for (const uint8_t channel : { p.r, p.g, p.b })
                sum += std::pow(channel / 255.0, 2.2);
        const double albedo = sum / double(image.pixels.size() * 3);
        EXPECT_GT(albedo, 0.005) << path;
        EXPECT_LT(albedo, 0.7) << path;
    }
}

TEST(Assets, MapsFindTheirTexturesAndSky)
{
    size_t maps = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(VKPT_BASEQ2_SOURCES) / "maps")) {
        if (entry.path().extension() != ".map")
            continue;
        maps++;
        const auto names = textures_of_map(entry.path());
        EXPECT_GT(names.size(), 5u);
        for (const std::string& name : names)
            EXPECT_TRUE(fs::exists(game().path() / "textures" / (name + ".wal"))) << entry.path() << " wants " << name;
    }
    EXPECT_GE(maps, 1u);
    for (const char* side : { "rt", "bk", "lf", "ft", "up", "dn" })
        EXPECT_TRUE(fs::exists(game().path() / "env" / ("vkpt1" + std::string(side) + ".tga")));
}

// The sky's pictures meet: the right border of one side continues in the left border of the next.
TEST(Assets, SkySidesMeet)
{
    const char* around[] = { "bk", "rt", "ft", "lf" }; // turning right from north
    for (int i = 0; i < 4; i++) {
        const Image a = read_any(game().path() / "env" / ("vkpt1" + std::string(around[i]) + ".tga"));
        const Image b = read_any(game().path() / "env" / ("vkpt1" + std::string(around[(i + 1) % 4]) + ".tga"));
        double sum = 0;
        for (int y = 0; y < a.height; y++)
            sum += std::abs(a.at(a.width - 1, y).r - b.at(0, y).r) + std::abs(a.at(a.width - 1, y).b - b.at(0, y).b);
        EXPECT_LT(sum / a.height, 6) << around[i];
    }
}

TEST(Assets, SoundsAreWaves)
{
    const auto files = game().files(".wav");
    ASSERT_GT(files.size(), 60u);
    for (const fs::path& path : files) {
        const auto bytes = load(path);
        ASSERT_GT(bytes.size(), 1000u) << path;
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        EXPECT_EQ(text.substr(0, 4), "RIFF");
        EXPECT_EQ(text.substr(8, 8), "WAVEfmt ");
        uint32_t riff = 0, data = 0;
        std::memcpy(&riff, bytes.data() + 4, 4);
        std::memcpy(&data, bytes.data() + 40, 4);
        EXPECT_EQ(riff + 8, bytes.size()) << path;
        int loudest = 0;
        for (uint32_t i = 0; i < data / 2; i++) {
            int16_t sample = 0;
            std::memcpy(&sample, bytes.data() + 44 + i * 2, 2);
            loudest = std::max(loudest, std::abs(int(sample)));
        }
        EXPECT_GT(loudest, 1500) << path << " is silent";
    }
}

TEST(Assets, CompiledMapIsComplete)
{
    const Bsp bsp = read_bsp(load(game().path() / "maps/vkpt1.bsp"), "maps/vkpt1.bsp");
    EXPECT_GT(bsp.cluster_count, 50);
    EXPECT_FALSE(bsp.lighting.empty());
    EXPECT_GE(bsp.models.size(), 5u); // the world, two door leaves, a lift, a travelling lantern
    size_t emitting = 0;
    std::set<std::string> kinds;
    for (const BspFace& face : bsp.faces) {
        const BspTexinfo& texinfo = bsp.texinfos[face.texinfo];
        if (texinfo.flags & SURF_LIGHT && !(texinfo.flags & SURF_SKY)) {
            emitting++;
            kinds.insert(texinfo.texture);
        }
    }
    EXPECT_GE(emitting, 30u);
    EXPECT_GE(kinds.size(), 12u);
    size_t starts = 0;
    for (const EntityText& entity : parse_entities(bsp.entity_text, "vkpt1"))
        if (entity.class_name() == "info_player_start") {
            starts++;
            EXPECT_GE(bsp.find_cluster(entity.vector("origin").value()), 0);
        }
    EXPECT_EQ(starts, 1u);
}

// The data in the build folder, and the same data made anew.
TEST(Assets, TwoRunsGiveTheSameBytes)
{
    using namespace vkpt::tools;
    const fs::path folder = fs::temp_directory_path() / ("vkpt_assets_" + std::to_string(getpid()));
    const Output out(folder);
    for (auto* subject : { &write_palette_and_font, &write_pictures, &write_sky, &write_weapon_models,
             &write_item_models, &write_player_models, &write_effect_models, &write_sounds, &write_textures })
        subject(out);
    const Data again(folder);
    const auto files = again.files("");
    EXPECT_GT(files.size(), 500u);
    for (const fs::path& path : files) {
        const fs::path built = game().path() / fs::relative(path, folder);
        EXPECT_TRUE(fs::exists(built) && load(path) == load(built)) << built << " differs from what is made now";
    }
    fs::remove_all(folder);
}
