// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/record/recorder.hpp"

#include "common/hash.hpp"
#include "common/trace/view_copy.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "formats/model.hpp"
#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

using trace::Call;
using trace::CallKind;

namespace {

// Variables that tell how the frames came about.
constexpr const char* fact_variables[] = { "version", "timedemo", "fixedtime", "cl_predict", "game", "record_demo" };

// Handles are places in it: pointers that ascend, as the engine sorts by them. A model's and a picture's may be the
// same.
constexpr size_t max_handles = 1 << 16;
char handle_places[max_handles];

Call make_text_call(CallKind kind, std::string_view name, std::string_view text)
{
    Call call = make_call(kind, name);
    call.text = text;
    return call;
}

} // namespace

Recorder::Recorder(const std::string& trace_path)
    : writer_(trace_path)
    , pictures_([this](const std::string& path) { return load_file(path); },
          [](std::string_view line) { engine::print("ref_record: {}", line); })
    , retexturing_(engine::get_cvar("r_retexturing", "1", engine::CVAR_ARCHIVE)->number != 0)
{
}

void Recorder::note_start(int width, int height)
{
    for (const char* name : fact_variables)
        if (const std::string text = engine::get_cvar(name, "", engine::CVAR_NONE)->text; !text.empty())
            write(make_text_call(CallKind::fact, name, text));
    write(make_call(CallKind::screen, "", { width, height }));
    if (const std::string demo = engine::get_cvar("record_demo", "", engine::CVAR_NONE)->text; !demo.empty())
        load_file("demos/" + demo);
    pictures_.load_palette();
}

void Recorder::note_settings()
{
    for (const auto& [name, initial] : trace::recorded_settings) {
        const std::string text = engine::get_cvar(name, initial, engine::CVAR_NONE)->text;
        const auto [known, is_new] = settings_.try_emplace(name, text);
        if (!is_new && known->second == text)
            continue;
        known->second = text;
        write(make_text_call(CallKind::setting, name, text));
    }
}

// Frames of 2D alone before the first view show the engine's console with the paths of this run: their drawing is left
// out, so that recording a demo again makes the same file. Whether a frame is one of them is known at its end.
void Recorder::write(Call call)
{
    if (totals().views > 0)
        writer_.write(std::move(call));
    else
        start_.push_back(std::move(call));
}

void Recorder::write_start(bool with_drawings)
{
    for (Call& call : start_)
        if (const bool is_drawing = call.kind >= CallKind::draw_pic && call.kind <= CallKind::draw_raw;
            with_drawings || !is_drawing)
            writer_.write(std::move(call));
    start_.clear();
}

void Recorder::begin_frame(float camera_separation)
{
    note_settings();
    write_start(false);
    write(make_call(CallKind::begin_frame, "", {}, { camera_separation }));
}

void Recorder::end_frame()
{
    write_start(false);
    writer_.write(make_call(CallKind::end_frame));
}

void Recorder::write_view(const engine::RefDef& from)
{
    trace::View view = trace::copy_view(from, to_number, to_number);
    write_start(true);
    writer_.write(view);
}

void Recorder::finish()
{
    write_start(false);
    writer_.finish();
}

// Every file that is read leaves its name, size and hash in the trace, once.
std::optional<std::vector<std::byte>> Recorder::load_file(const std::string& path)
{
    const std::optional<engine::FileData> file = engine::load_file(path);
    if (!file)
        return std::nullopt;
    const formats::Bytes bytes = file->bytes();
    if (noted_files_.insert(path).second)
        write(trace::make_file_call(path, bytes.size(), hash_bytes(bytes)));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

void Recorder::begin_registration(std::string_view map)
{
    map_ = "maps/" + std::string(map) + ".bsp";
    brush_models_ = 0;
    pictures_.begin_level();
    noted_files_.erase(map_); // another map of the same name may have come
    const auto file = load_file(map_);
    if (!file)
        throw LevelError(map_ + " does not exist: is the map's package installed?");
    const formats::Bsp bsp = formats::read_bsp(*file, map_);
    brush_models_ = bsp.models.size();
    for (const formats::BspTexinfo& info : bsp.texinfos)
        number_picture(info.texture, TextureUse::wall);
}

bool Recorder::is_usable_model(const std::string& name)
{
    if (name.starts_with('*'))
        return formats::brush_model_index(name).value_or(brush_models_) < brush_models_;
    if (name.ends_with(".bsp"))
        return brush_models_ > 0;
    const bool is_replaced = note_replacement(name);
    const auto file = load_file(name);
    if (!file)
        return is_replaced;
    if (name.ends_with(".sp2")) {
        for (const formats::Sp2Sprite::Frame& frame : formats::read_sp2(*file, name).frames)
            number_picture(frame.picture, TextureUse::sprite);
    } else {
        number_skins(formats::read_mesh(*file, name));
    }
    return true;
}

void Recorder::number_skins(const std::vector<formats::Md2Model>& surfaces)
{
    for (const formats::Md2Model& surface : surfaces)
        for (const std::string& skin : surface.skins)
            number_picture(skin, TextureUse::skin);
}

// What stands for the model in a replay, as it does in the game. False: nothing that can be read.
bool Recorder::note_replacement(const std::string& name)
{
    if (!retexturing_)
        return false;
    for (const std::string& path : formats::replacements_of_mesh(name)) {
        const auto file = load_file(path);
        if (!file)
            continue;
        try {
            number_skins(formats::read_mesh(*file, path));
            return true;
        } catch (const formats::FormatError&) {
            return false; // the module says why
        }
    }
    return false;
}

void* Recorder::register_model(std::string_view name)
{
    uint32_t number = 0;
    try {
        if (!name.empty() && is_usable_model(std::string(name))) {
            const auto [known, is_new] = models_.try_emplace(std::string(name), model_count_ + 1);
            model_count_ += is_new;
            number = known->second;
        }
    } catch (const formats::FormatError& error) {
        engine::print("ref_record: {}", error.what());
    }
    write(make_call(CallKind::register_model, name, { int32_t(number) }));
    return to_handle(number);
}

void* Recorder::register_skin(std::string_view name)
{
    const uint32_t number = number_picture(name, TextureUse::skin);
    write(make_call(CallKind::register_skin, name, { int32_t(number) }));
    return to_handle(number);
}

void Recorder::find_sky(std::string_view name)
{
    for (const char* side : { "rt", "bk", "lf", "ft", "up", "dn" })
        number_picture(std::string(name) + side, TextureUse::sky);
}

Recorder::PictureSize Recorder::find_pic(std::string_view name)
{
    number_picture(name, TextureUse::image);
    return known_pictures_[{ TextureUse::image, std::string(name) }].second;
}

void* Recorder::picture_handle(const PictureSize& size) { return size.width < 0 ? nullptr : to_handle(1); }

uint32_t Recorder::number_picture(std::string_view name, TextureUse use)
{
    const auto [known, is_new] = known_pictures_.try_emplace({ use, std::string(name) });
    auto& [number, size] = known->second;
    if (is_new)
        if (const auto picture = pictures_.load(name, use, { .retexturing = retexturing_ })) {
            number = ++picture_count_;
            size = { picture->width, picture->height };
        }
    return number;
}

void* Recorder::to_handle(uint32_t number)
{
    if (number >= max_handles)
        throw LevelError("more than 65535 models or pictures are in use: record fewer maps in one trace");
    return number ? &handle_places[number] : nullptr;
}

uint32_t Recorder::to_number(const void* handle)
{
    return handle ? uint32_t(static_cast<const char*>(handle) - handle_places) : 0;
}

} // namespace vkpt
