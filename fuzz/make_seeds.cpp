// SPDX-License-Identifier: GPL-2.0-or-later
// make_seeds FOLDER: the inputs that fuzzing starts from, one folder below FOLDER for each harness; all made by our own
// writers.
#include "common/trace/trace_writer.hpp"
#include "formats/byte_writer.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "tests/formats/samples.hpp"
#include "tests/lights/synthetic_bsp.hpp"
#include "tests/map_compiler/map_text.hpp"
#include "tools/map_compiler/compiler.hpp"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace {

using namespace vkpt;
namespace fs = std::filesystem;

fs::path root;

void add(const std::string& harness, const std::string& name, std::span<const std::byte> bytes)
{
    fs::create_directories(root / harness);
    std::ofstream file(root / harness / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        throw std::runtime_error("cannot write " + (root / harness / name).string());
}

void add_text(const std::string& harness, const std::string& name, std::string_view text)
{
    add(harness, name, std::as_bytes(std::span(text)));
}

formats::Bsp compile(const std::string& text)
{
    tools::CompileOptions options;
    options.threads = 1;
    options.light = false;
    return tools::compile_map(text, "seed.map", options);
}

// One room with a lamp: the smallest map that the compiler makes.
std::string room_text()
{
    const tests::Box room { { -64, -64, 0 }, { 64, 64, 96 } };
    return tests::entity_text(
               { { "classname", "worldspawn" }, { "message", "seed" } }, tests::walls_around({ room }, "wall"))
        + tests::entity_text({ { "classname", "info_player_start" }, { "origin", "0 0 32" }, { "angle", "90" } })
        + tests::entity_text(
            { { "classname", "light" }, { "origin", "0 0 64" }, { "light", "200" }, { "_color", "1 .5 0" } })
        + tests::entity_text({ { "classname", "func_door" }, { "angle", "-1" }, { "lip", "8" }, { "spawnflags", "1" } },
            tests::box_brush({ { 16, 16, 0 }, { 32, 32, 48 } }, "door"));
}

void add_map(const std::string& name, formats::Bsp bsp)
{
    add("bsp", name, formats::write_bsp(bsp));
    bsp.format = formats::BspFormat::qbsp;
    add("bsp", name + "-wide", formats::write_bsp(bsp));
}

void add_maps()
{
    add_map("sample", samples::make_bsp());
    add_map("cells", test::make_cell_map(3, std::vector<bool>(9, true)));
    add_map("random_cells", test::make_cell_map(5, test::make_random_cells(5, 0.6, 1)));
    add_map("room", compile(room_text()));
    add_map("rooms", compile(tests::two_rooms::text()));
    for (const char* first : { "0", "1", "2", "3" }) { // which steps are made, see map_source_fuzzer.cpp
        add_text("map_source", fmt::format("room{}", first), first + room_text());
        add_text("map_source", fmt::format("open_room{}", first), first + tests::open_room_text());
    }
    add_text("map_source", "rooms", "1" + tests::two_rooms::text());
    add_text("entities", "sample", samples::make_bsp().entity_text);
    add_text("entities", "room", compile(room_text()).entity_text);
    add_text("entities", "rooms", compile(tests::two_rooms::text()).entity_text);
    add_text("materials", "sample",
        "# a comment\ntextures/e1u1/floor.wal,\nmodels/x/skin:\n    roughness_override 0.3\n    texture_normals "
        "overrides/floor_n.tga\n"
        "    kind CHROME\n");
    add_text("cameras", "sample",
        "# a comment\n(100, -250.5, 64) (0.7, 0.7, -0.1)\n(0, 0, 128) (1, 0, -0.5) 60 # the door\n(1, 2) "
        "(3)\n(1, 2, 3) (0, 0, 0)\n");
    add_text("game_text", "lights",
        "l# vkpt lights of sample\nlight 0 0 64 0 0 #ff8040 450 2 pulse\nlight 8 8 64 30 90 red 200 1 spot 40 # a "
        "comment\nlight 0 0 0 0 0 orbit 64 4\n");
    add_text("game_text", "walk",
        "w# vkpt walk in sample\ngoto 1 2 3\nwait .5\nlook -10 20\ninput 1.5 forward 200 side -100 up 10 pitch 4 yaw "
        "90 "
        "attack\nstep 1 2 3 4 5 jump .25 duck attack\n");
    for (const char* name : { "func_door", "func_door_rotating", "func_plat", "func_train", "func_rotating",
             "func_wall", "func_object", "func_explosive", "func_button", "func_water" })
        add_text("entities", name,
            tests::entity_text({ { "classname", name }, { "model", "*1" }, { "target", "t" }, { "angle", "45" },
                { "speed", "100" }, { "lip", "4" }, { "height", "32" }, { "distance", "90" }, { "spawnflags", "65" } })
                + tests::entity_text({ { "classname", "path_corner" }, { "targetname", "t" }, { "origin", "1 2 3" } }));
}

// The head of a picture with 256 colours, three planes, and one value for each of its lines.
std::vector<std::byte> make_true_colour_pcx(int size)
{
    constexpr size_t header = 128, planes_at = 65;
    std::vector<std::byte> file = formats::write_pcx(samples::make_indexed_image(size, size));
    file.resize(header);
    file[planes_at] = std::byte { 3 };
    for (int line = 0; line < 3 * size; line++) {
        file.push_back(std::byte(0xc0 | size)); // a run
        file.push_back(std::byte(40 * line));
    }
    return file;
}

void add_pictures()
{
    for (const int size : { 1, 5, 16 }) {
        const formats::IndexedImage indexed = samples::make_indexed_image(size, size);
        const formats::Image image = samples::make_image(size, size);
        const std::string name = std::to_string(size);
        add("pcx", name, formats::write_pcx(indexed));
        add("pcx", name + "-true-colour", make_true_colour_pcx(size));
        add("tga", name, formats::write_tga(image));
        add("png", name, formats::write_png(image));
        add("jpg", name, samples::make_jpg(size, size));
    }
    const formats::WallInfo info { "e1u1/wall", "e1u1/wall2", 16, 16, 1, 1, 300 };
    add("wal", "16", formats::write_wal(samples::make_indexed_image(16, 16), info));
    add("tga", "packed", samples::make_packed_tga());
    add("m8", "m8", samples::make_m8());
    add("m32", "m32", samples::make_m32());
}

void add_models()
{
    add("md2", "tetrahedron", formats::write_md2(samples::make_md2()));
    formats::Md2Model many = samples::make_md2();
    while (many.frames.size() < 8)
        many.frames.push_back(many.frames[many.frames.size() % 2]);
    for (int i = 0; i < 4; i++)
        many.indices.insert(many.indices.end(), many.indices.begin(), many.indices.begin() + 12);
    add("md2", "larger", formats::write_md2(many));
    add("md3", "tetrahedra", formats::write_md3(samples::make_md3()));
    add("md3", "larger", formats::write_md3(std::vector(3, many)));
    formats::IqmModel arm = samples::make_iqm();
    add("iqm", "arm", formats::write_iqm(arm));
    arm.frames.clear();
    add("iqm", "bound", formats::write_iqm(arm));
    arm.joints.clear();
    add("iqm", "still", formats::write_iqm(arm));
    add("sp2", "sprite", formats::write_sp2(samples::make_sp2()));
    formats::Sp2Sprite long_one = samples::make_sp2();
    while (long_one.frames.size() < 32)
        long_one.frames.push_back(long_one.frames[0]);
    add("sp2", "long", formats::write_sp2(long_one));
}

trace::Call make_call(trace::CallKind kind, int number)
{
    trace::Call call;
    call.kind = kind;
    const trace::CallForm& form = trace::form_of(kind);
    if (form.name)
        call.name = fmt::format("name{}", number % 3);
    if (form.text)
        call.text = "text";
    for (size_t i = 0; i < form.numbers; i++)
        call.numbers[i] = number + int(i);
    for (size_t i = 0; i < form.reals; i++)
        call.reals[i] = float(number) + 0.5f;
    if (form.data)
        call.data.resize(kind == trace::CallKind::set_palette ? 768 : 64);
    return call;
}

trace::View make_view(int number)
{
    trace::View view;
    view.refdef.width = 640;
    view.refdef.height = 480;
    view.refdef.fov_x = view.refdef.fov_y = 90;
    view.refdef.time = float(number) / 60;
    view.entities.resize(size_t(3 + number % 2));
    for (trace::View::Entity& entity : view.entities) {
        entity.model = 1;
        entity.entity.origin[0] = float(number);
        entity.entity.frame = number;
    }
    view.dlights.push_back({ { 1, 2, float(number) }, { 1, 0.5f, 0 }, 200 });
    view.particles.resize(4, { { 1, 2, 3 }, 7, 0.5f });
    view.has_lightstyles = view.has_area_bits = true;
    view.lightstyles[0] = { { 1, 1, 1 }, 3 };
    return view;
}

std::vector<std::byte> read_back(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    const auto whole = std::as_bytes(std::span(bytes));
    return { whole.begin(), whole.end() };
}

// Every kind of call, then `frames` frames.
void add_trace(const std::string& name, int frames, bool whole)
{
    using trace::CallKind;
    const fs::path path = root / "trace.part";
    {
        trace::TraceWriter writer(path);
        for (int kind = 0; kind < int(CallKind::count); kind++)
            if (CallKind(kind) != CallKind::render_view)
                writer.write(make_call(CallKind(kind), kind));
        for (int frame = 0; frame < frames; frame++) {
            writer.write(make_call(CallKind::begin_frame, 0));
            trace::View view = make_view(frame);
            writer.write(view);
            writer.write(make_call(CallKind::draw_pic, frame));
            writer.write(make_call(CallKind::end_frame, 0));
        }
        if (whole)
            writer.finish();
    }
    if (whole || frames > 64)
        add("trace", name, read_back(path));
    fs::remove(path);
}

// A row of calls of frames_fuzzer.cpp: a byte that says which, then its numbers.
void add_frames()
{
    formats::ByteWriter row;
    for (const int entity : { 0, 1, 2, 6, 0x80 }) {
        row.write(uint8_t(0));
        row.write(uint8_t(entity));
        engine::Entity numbers {};
        numbers.origin[0] = float(entity);
        numbers.frame = 1;
        numbers.backlerp = numbers.alpha = 0.5f;
        numbers.flags = entity == 6 ? engine::RF_BEAM : entity == 1 ? engine::RF_TRANSLUCENT : engine::RF_SHELL_RED;
        row.write(numbers);
    }
    row.write(uint8_t(1));
    row.write(engine::DynamicLight { { 0, 0, 32 }, { 1, 0.5f, 0 }, 200 });
    row.write(uint8_t(2));
    row.write(engine::Particle { { 0, 0, 16 }, 7, 0.5f });
    for (int i = 0; i < 2; i++) {
        row.write(uint8_t(3));
        engine::RefDef view {};
        view.width = 640;
        view.height = 480;
        view.fov_x = view.fov_y = 90;
        view.view_origin[2] = 24;
        view.time = float(i);
        row.write(view);
    }
    add("frames", "view", row.take());
    formats::ByteWriter drawn;
    for (int kind = 0; kind < 16; kind++) {
        drawn.write(uint8_t(4));
        drawn.write(uint8_t(kind));
        drawn.write(std::array<int32_t, 4> { 10, 20, 64, 32 });
        drawn.write(std::array<float, 4> { 1, 1, 0.5f, 0 });
        if (kind % 8 == 6)
            drawn.write(std::array<uint8_t, 3> { 16, 16, 1 });
    }
    for (const int kind : { 5, 6, 7 }) {
        drawn.write(uint8_t(kind));
        drawn.write(std::array<float, 5> { 1, 0, 0, 1, 1 });
    }
    add("frames", "drawn", drawn.take());
}

void add_texts()
{
    uint8_t number = 0;
    std::string all;
    for (const CvarRow& row : cvar_rows) {
        const std::string line = std::string(1, char(number++)) + (*row.choices ? row.choices : row.initial) + "\n";
        all += line;
        add_text("cvars", row.name, line);
    }
    add_text("cvars", "first_sixteen", all.substr(0, 300));
    for (const char* name : { "e1u1/floor", "pics/inven.pcx", "/players/male/a_i.pcx", "models/a/tris.md2",
             "shots/../../x", "unit1_", "env/sky.tga", "a\\b", "..", "" })
        add_text("paths", fmt::format("{:08x}", std::hash<std::string>()(name)), std::string("\xff") + name);
    for (const char* text :
        { "maps/a.bsp", "maps/a.bsp@1,2,3", "maps/a.bsp@1,-2.5,3e1,4,5", "1280x720", "1x1", "a=b", "pt_bounces=2" })
        add_text("options", fmt::format("{:08x}", std::hash<std::string>()(text)), text);
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", arguments[0]);
        return 2;
    }
    try {
        root = arguments[1];
        fs::create_directories(root);
        add_maps();
        add_pictures();
        add_models();
        add_trace("whole", 3, true);
        add_trace("cut", 70, false);
        add_frames();
        add_texts();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", arguments[0], error.what());
        return 1;
    }
    return 0;
}
