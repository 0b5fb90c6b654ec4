// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/trace_frames.hpp"

#include "client/host/blend_views.hpp"
#include "client/host/errors.hpp"
#include "client/host/hash.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace vkpt::client {

using trace::Call;
using trace::CallKind;
using trace::LastingCall;

namespace {

// The recording module hands out fewer.
constexpr size_t max_handles = 1 << 16;

uint64_t join(int32_t low, int32_t high) { return uint64_t(uint32_t(low)) | uint64_t(uint32_t(high)) << 32; }

struct Fingerprint {
    uint64_t bytes, hash;
};

// The same for all paths that FileSystem takes for the same.
std::string plain_path(std::string path)
{
    for (char& c : path)
        c = c == '\\' ? '/' : c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c;
    return path.substr(std::min(path.find_first_not_of('/'), path.size()));
}

// Another eye than the player's sees the player, and not the weapon before the player's eyes.
void move_eye(const Camera& camera, engine::RefDef& refdef, std::vector<engine::Entity>& entities)
{
    for (int i = 0; i < 3; i++)
        refdef.view_origin[i] = camera.position[i];
    refdef.view_angles[0] = camera.pitch;
    refdef.view_angles[1] = camera.yaw;
    refdef.view_angles[2] = 0;
    refdef.blend[3] = 0;
    refdef.flags &= ~engine::RDF_UNDERWATER;
    refdef.area_bits = nullptr;
    std::erase_if(entities, [](const engine::Entity& e) { return (e.flags & engine::RF_WEAPONMODEL) != 0; });
    for (engine::Entity& entity : entities)
        entity.flags &= ~engine::RF_VIEWERMODEL;
}

} // namespace

void TraceFrames::Handles::keep(int32_t number, void* handle)
{
    if (number <= 0 || size_t(number) >= max_handles)
        return;
    if (handles_.size() <= size_t(number))
        handles_.resize(size_t(number) + 1);
    handles_[size_t(number)] = handle;
}

void* TraceFrames::Handles::find(uint32_t number) const
{
    return number < handles_.size() ? handles_[number] : nullptr;
}

TraceFrames::TraceFrames(FileSystem& files, std::string_view path, int chosen_frame)
    : path_(path)
    , reader_(path_)
    , chosen_frame_(chosen_frame)
{
    const size_t count = reader_.frame_count();
    if (count == 0)
        throw Failure(fmt::format("{} has no frames{}: record it again", path,
            reader_.cut_at() ? fmt::format(", it was cut off at byte {}", reader_.cut_at()) : ""));
    if (size_t(chosen_frame) >= count)
        throw WrongUse(fmt::format("{} has frames 0 to {}, not {}", path, count - 1, chosen_frame));
    if (reader_.cut_at())
        notes_.push_back(
            fmt::format("{} was cut off at byte {}: it has {} frames, the last {:.1f} seconds after the first", path,
                reader_.cut_at(), count, seconds(int(count) - 1)));
    check_files(files);
}

// The same files are needed as when it was recorded; only maps are worth ending for.
void TraceFrames::check_files(FileSystem& files)
{
    std::vector<std::string> others;
    std::map<std::string, std::optional<Fingerprint>> prints; // each file is read once, however often it is named
    for (const Call& call : reader_.facts()) {
        if (call.kind != CallKind::file)
            continue;
        const auto [known, is_new] = prints.try_emplace(plain_path(call.name));
        if (is_new)
            if (const auto bytes = files.read(call.name))
                known->second = { bytes->size(), hash_bytes(*bytes) };
        const std::optional<Fingerprint>& found = known->second;
        if (!found && call.name.ends_with(".bsp"))
            throw Failure(fmt::format("{} was recorded in {}, which is not in\n  {}\nName the game data that it was "
                                      "recorded with: --basedir DIR, --game NAME.",
                path_, call.name, fmt::join(files.search_path(), "\n  ")));
        if (!found || found->bytes != join(call.numbers[0], call.numbers[1])
            || found->hash != join(call.numbers[2], call.numbers[3]))
            others.push_back(fmt::format("{} ({})", call.name, found ? "another" : "missing"));
    }
    if (others.empty())
        return;
    constexpr size_t named = 5;
    const size_t count = others.size();
    others.resize(std::min(count, named));
    notes_.push_back(fmt::format("{} of the files that {} was recorded with differ here: {}{}", count, path_,
        fmt::join(others, ", "), count > named ? " ..." : ""));
}

double TraceFrames::seconds(int frame) const { return reader_.seconds(size_t(frame)); }

Camera TraceFrames::camera(int frame) const
{
    if (camera_)
        return *camera_;
    const engine::RefDef& refdef = reader_.frame(size_t(frame)).views.front().refdef;
    return { { refdef.view_origin[0], refdef.view_origin[1], refdef.view_origin[2] }, refdef.view_angles[0],
        refdef.view_angles[1] };
}

void TraceFrames::register_with(Host& host)
{
    placement_ = { host.width(), host.height(), host.width(), host.height() };
    for (const Call& call : reader_.facts())
        if (call.kind == CallKind::screen && call.numbers[0] > 0 && call.numbers[1] > 0)
            placement_ = { call.numbers[0], call.numbers[1], host.width(), host.height() };
    applied_ = 0;
    models_ = {};
    skins_ = {};
    prepare(host, lasting_before(size_t(chosen_frame_)));
}

// How many of the lasting calls come before the frame's own.
size_t TraceFrames::lasting_before(size_t frame) const
{
    const std::vector<LastingCall>& calls = reader_.lasting_calls();
    const auto end = std::ranges::partition_point(
        calls, [&](const LastingCall& c) { return c.frame < frame || (c.frame == frame && !c.is_inside); });
    return size_t(end - calls.begin());
}

// Where the registration begins that is in force after so many lasting calls.
size_t TraceFrames::registration_of(size_t lasting_count) const
{
    const std::vector<LastingCall>& calls = reader_.lasting_calls();
    for (size_t i = lasting_count; i-- > 0;)
        if (calls[i].call.kind == CallKind::begin_registration)
            return i;
    return 0;
}

// Brings the module to where it is after the first `lasting_count` lasting calls: forward by the calls in between, to
// another map by registering that; what one map has registered beyond the wanted place does not matter.
void TraceFrames::prepare(Host& host, size_t lasting_count)
{
    const std::vector<LastingCall>& calls = reader_.lasting_calls();
    const bool goes_back = lasting_count < applied_;
    const size_t start = registration_of(lasting_count);
    if (goes_back || start > applied_) {
        const bool is_same_map = goes_back && start == registration_of(applied_);
        applied_ = is_same_map ? applied_ : start;
        for (size_t i = 0; i < (is_same_map ? lasting_count : start); i++)
            if (calls[i].call.kind == CallKind::setting)
                set(host, calls[i].call);
    }
    while (applied_ < lasting_count)
        apply(host, calls[applied_++].call);
}

void TraceFrames::set(Host& host, const Call& setting)
{
    if (!host.is_chosen(setting.name))
        host.cvars().set(setting.name, setting.text);
}

void TraceFrames::apply(Host& host, const Call& call)
{
    const engine::Exports8& module = host.module();
    switch (call.kind) {
    case CallKind::setting:
        return set(host, call);
    case CallKind::begin_registration:
        return module.begin_registration(call.name.c_str());
    case CallKind::register_model:
        return models_.keep(call.numbers[0], module.register_model(call.name.c_str()));
    case CallKind::register_skin:
        return skins_.keep(call.numbers[0], module.register_skin(call.name.c_str()));
    case CallKind::set_sky:
        return module.set_sky(call.name.c_str(), call.reals[0], &call.reals[1]);
    case CallKind::end_registration:
        return module.end_registration();
    case CallKind::set_palette: {
        constexpr size_t palette_bytes = 768;
        return module.set_palette(
            call.data.size() < palette_bytes ? nullptr : reinterpret_cast<const uint8_t*>(call.data.data()));
    }
    default:
        break;
    }
}

void TraceFrames::draw_frame(Host& host, int number)
{
    size_t lasting = lasting_before(size_t(number));
    prepare(host, lasting);
    const trace::Frame& frame = reader_.frame(size_t(number));
    const engine::Exports8& module = host.module();
    host.run_left_text();
    size_t view = 0;
    for (const Call& call : frame.calls) {
        if (call.kind == CallKind::begin_frame)
            module.begin_frame(call.reals[0]);
        else if (call.kind == CallKind::render_view)
            draw_view(host, frame.views[view++]);
        else if (call.kind == CallKind::end_frame)
            module.end_frame();
        else if (call.kind == CallKind::end_world_renderpass)
            module.end_world_renderpass();
        else if (trace::is_lasting(call.kind))
            prepare(host, std::max(applied_, ++lasting));
        else
            draw_2d(module, call);
    }
}

// Of the world, if there is one.
static const trace::View& main_view(const trace::Frame& frame)
{
    const auto world = std::ranges::find_if(
        frame.views, [](const trace::View& view) { return !(view.refdef.flags & engine::RDF_NOWORLDMODEL); });
    return world != frame.views.end() ? *world : frame.views.front();
}

const TraceFrames::Pair& TraceFrames::find_pair(size_t frame)
{
    if (pair_.frame == frame)
        return pair_;
    const std::vector<LastingCall>& calls = reader_.lasting_calls();
    const size_t next = std::min(frame + 1, reader_.frame_count() - 1);
    const size_t own = size_t(
        std::ranges::partition_point(calls, [&](const LastingCall& c) { return c.frame <= frame; }) - calls.begin());
    const size_t later = lasting_before(next);
    pair_.frame = frame;
    pair_.before = main_view(reader_.frame(frame));
    pair_.after = main_view(reader_.frame(next));
    pair_.is_cut = registration_of(std::max(own, later)) != registration_of(own);
    pair_.lasting = pair_.is_cut ? own : std::max(own, later);
    return pair_;
}

void TraceFrames::draw_moment(Host& host, double seconds, bool blends)
{
    size_t frame = 0, end = reader_.frame_count();
    while (end - frame > 1) {
        const size_t middle = (frame + end) / 2;
        (reader_.seconds(middle) <= seconds ? frame : end) = middle;
    }
    const Pair& pair = find_pair(frame);
    prepare(host, pair.lasting);
    const double start = reader_.seconds(frame),
                 length = reader_.seconds(std::min(frame + 1, reader_.frame_count() - 1)) - start;
    const float share = length > 0 && !pair.is_cut ? float(std::clamp((seconds - start) / length, 0.0, 1.0)) : 0.0f;
    blends ? host.extension().blend_next_view() : host.extension().thaw_scene();
    host.run_left_text();
    host.module().begin_frame(0);
    draw_view(host, blend_views(pair.before, pair.after, share));
    host.module().end_frame();
}

void TraceFrames::draw_view(Host& host, const trace::View& view)
{
    engine::RefDef refdef = view.refdef;
    std::vector<engine::Entity> entities;
    for (const trace::View::Entity& recorded : view.entities) {
        engine::Entity& entity = entities.emplace_back(recorded.entity);
        entity.model = models_.find(recorded.model);
        entity.skin = skins_.find(recorded.skin);
    }
    refdef.area_bits = view.has_area_bits ? view.area_bits.data() : nullptr;
    refdef.lightstyles = view.has_lightstyles ? view.lightstyles.data() : nullptr;
    placement_.place_view(refdef);
    if (camera_ && !(refdef.flags & engine::RDF_NOWORLDMODEL))
        move_eye(*camera_, refdef, entities);
    refdef.entity_count = int32_t(entities.size());
    refdef.entities = entities.data();
    refdef.dlight_count = int32_t(view.dlights.size());
    refdef.dlights = view.dlights.data();
    refdef.particle_count = int32_t(view.particles.size());
    refdef.particles = view.particles.data();
    host.module().render_frame(&refdef);
}

void TraceFrames::draw_2d(const engine::Exports8& module, const Call& call) const
{
    const auto& n = call.numbers;
    const char* name = call.name.c_str();
    const int x = placement_.place_x(n[0]), y = placement_.place_y(n[1]);
    const Rectangle r = placement_.place({ n[0], n[1], n[2], n[3] });
    const float scale = call.reals[0] * placement_.scale();
    int width = 0, height = 0;
    switch (call.kind) {
    case CallKind::find_pic:
        module.draw_find_pic(name);
        break;
    case CallKind::picture_size:
        module.draw_get_pic_size(&width, &height, name);
        break;
    case CallKind::draw_pic:
        call.flag ? module.draw_pic_scaled_tinted(x, y, name, scale, &call.reals[1])
                  : module.draw_pic_scaled(x, y, name, scale);
        break;
    case CallKind::draw_stretched:
        module.draw_stretch_pic(r.x, r.y, r.width, r.height, name);
        break;
    case CallKind::draw_character:
        module.draw_char_scaled(x, y, n[2], scale);
        break;
    case CallKind::draw_tiled:
        module.draw_tile_clear(r.x, r.y, r.width, r.height, name);
        break;
    case CallKind::draw_fill:
        module.draw_fill(r.x, r.y, r.width, r.height, n[4]);
        break;
    case CallKind::draw_fade:
        module.draw_fade_screen();
        break;
    case CallKind::draw_raw:
        if (n[4] > 0 && n[5] > 0 && call.data.size() >= size_t(n[4]) * size_t(n[5]) * size_t(n[6] == 32 ? 4 : 1))
            module.draw_stretch_raw(
                r.x, r.y, r.width, r.height, n[4], n[5], reinterpret_cast<const uint8_t*>(call.data.data()), n[6]);
        break;
    default:
        break;
    }
}

} // namespace vkpt::client
