// SPDX-License-Identifier: GPL-2.0-or-later
// What a trace holds: the engine's calls, in order. Handles are numbers from 1, which ascend as the module's pointers
// do; 0 is none.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::trace {

// The numbers are in files: new ones go to the end, with a row in call_forms.
enum class CallKind : uint8_t {
    fact, // name, text: how it was recorded
    file, // name, numbers: what was loaded; size and hash, each low and high word
    setting, // name, text: a console variable that changes what is shown; as it is from here on
    screen, // numbers: width, height of the window

    begin_registration, // name: of the map
    register_model, // name, number: the handle that the engine got
    register_skin, // name, number
    set_sky, // name, reals: degrees per second, axis
    end_registration,

    begin_frame, // real: camera separation
    render_view, // the next of Frame::views
    end_world_renderpass,
    end_frame,

    find_pic, // name; flag: the engine got a handle
    picture_size, // name, numbers: the width and height that the engine got
    // Drawing in frames before the first one with a view is left out.
    draw_pic, // name, numbers: x, y; reals: scale, tint; flag: tinted
    draw_stretched, // name, numbers: x, y, width, height
    draw_character, // numbers: x, y, code; real: scale
    draw_tiled, // name, numbers: x, y, width, height
    draw_fill, // numbers: x, y, width, height, palette index
    draw_fade,
    draw_raw, // numbers: x, y, width, height, columns, rows, bits; data: pixels
    set_palette, // data: 768 bytes, or none: the game's own
    count
};

// Which fields of Call a kind has.
struct CallForm {
    const char* word; // for people
    bool name, text, flag, data;
    uint8_t numbers, reals;
};
inline constexpr std::array<CallForm, size_t(CallKind::count)> call_forms { {
    { "fact", true, true, false, false, 0, 0 },
    { "file", true, false, false, false, 4, 0 },
    { "setting", true, true, false, false, 0, 0 },
    { "screen", false, false, false, false, 2, 0 },
    { "begin registration", true, false, false, false, 0, 0 },
    { "register model", true, false, false, false, 1, 0 },
    { "register skin", true, false, false, false, 1, 0 },
    { "set sky", true, false, false, false, 0, 4 },
    { "end registration", false, false, false, false, 0, 0 },
    { "begin frame", false, false, false, false, 0, 1 },
    { "render view", false, false, false, false, 0, 0 },
    { "end world renderpass", false, false, false, false, 0, 0 },
    { "end frame", false, false, false, false, 0, 0 },
    { "find picture", true, false, true, false, 0, 0 },
    { "picture size", true, false, false, false, 2, 0 },
    { "draw picture", true, false, true, false, 2, 4 },
    { "draw stretched", true, false, false, false, 4, 0 },
    { "draw character", false, false, false, false, 3, 1 },
    { "draw tiled", true, false, false, false, 4, 0 },
    { "draw fill", false, false, false, false, 5, 0 },
    { "draw fade", false, false, false, false, 0, 0 },
    { "draw raw", false, false, false, true, 7, 0 },
    { "set palette", false, false, false, true, 0, 0 },
} };
inline const CallForm& form_of(CallKind kind) { return call_forms[size_t(kind)]; }

struct Call {
    CallKind kind = CallKind::end_frame;
    bool flag = false;
    std::string name, text;
    std::array<int32_t, 7> numbers {};
    std::array<float, 4> reals {};
    std::vector<std::byte> data;

    bool operator==(const Call&) const = default;
};

inline Call make_call(CallKind kind, std::string_view name = "", std::initializer_list<int32_t> numbers = {},
    std::initializer_list<float> reals = {})
{
    Call call;
    call.kind = kind;
    call.name = name;
    std::ranges::copy(numbers, call.numbers.begin());
    std::ranges::copy(reals, call.reals.begin());
    return call;
}

// What was loaded from `path`: `hash` is hash_bytes() of all of it.
inline Call make_file_call(std::string_view path, uint64_t size, uint64_t hash)
{
    return make_call(CallKind::file, path, { int32_t(size), int32_t(size >> 32), int32_t(hash), int32_t(hash >> 32) });
}

// The console variables that a trace holds: of the engine's, those that change how the module shows a view. No other is
// taken from a file, as some make the module write files.
struct RecordedSetting {
    const char *name, *initial;
};
inline constexpr std::array<RecordedSetting, 5> recorded_settings { { { "hand", "0" }, { "r_gunfov", "80" },
    { "vid_gamma", "1.2" }, { "gl3_intensity_2D", "1.5" }, { "skin", "male/grunt" } } };

inline constexpr size_t max_area_bytes = 32; // 256 areas, a bit each

// A RefDef that owns what it points to; its pointers are not used.
struct View {
    engine::RefDef refdef {};
    struct Entity {
        engine::Entity entity; // without its pointers
        uint32_t model = 0, skin = 0; // handle numbers
    };
    std::vector<Entity> entities;
    std::vector<engine::DynamicLight> dlights;
    std::vector<engine::Particle> particles;
    bool has_lightstyles = false, has_area_bits = false;
    std::array<engine::Lightstyle, engine::max_lightstyles> lightstyles {};
    std::array<uint8_t, max_area_bytes> area_bits {};
};

} // namespace vkpt::trace
