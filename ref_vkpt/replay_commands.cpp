// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/replay_commands.hpp"

#include "common/hash.hpp"
#include "common/numbers.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/files/new_files.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/module.hpp"
#include "ref_vkpt/pass_statistics.hpp"
#include "ref_vkpt/photo_commands.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkpt {

namespace {

using trace::Call;
using trace::CallKind;

constexpr double slowest = 1.0 / 64, fastest = 16;

void say(Module& m, const std::string& message)
{
    engine::print("pt_replay: {}", message);
    m.photo.say(message);
}

// What a trace says before what is registered: the window, settings, and the map's file.
std::vector<Call> make_head(const Module& m)
{
    std::vector<Call> head { make_call(
        CallKind::screen, "", { int32_t(m.graphics.size().width), int32_t(m.graphics.size().height) }) };
    const std::string map = fmt::format("maps/{}.bsp", m.replay_ring.map());
    if (const auto file = engine::load_file(map))
        head.push_back(trace::make_file_call(map, file->bytes().size(), hash_bytes(file->bytes())));
    for (const auto& [name, initial] : trace::recorded_settings)
        head.emplace_back(make_call(CallKind::setting, name)).text
            = engine::get_cvar(name, initial, engine::CVAR_NONE)->text;
    return head;
}

void enter_replay(Module& m)
{
    constexpr double shown_at_first = 10; // seconds
    if (!m.scene.world() || !m.view().snapshot || m.graphics.is_recording() || m.replay_ring.is_empty())
        return engine::print("pt_replay: there is nothing to show: pt_replay_seconds is 0, or no map was played");
    leave_photo_mode(m);
    Replay& replay = m.replay.emplace(m.replay_ring.make_trace(make_head(m)), m.replay_ring.handles());
    replay.seek(replay.length() - shown_at_first);
    replay.play(1);
    enter_photo_mode(m);
}

void save_replay(Module& m, const std::string& name)
{
    const NewFile file[] = { { ".rtrace", m.replay_ring.make_trace(make_head(m)) } };
    try {
        const auto paths = save_new_files(engine::game_directory(),
            { "replays", "replay", name, file, uint64_t(cvars::values().pt_capture_mib) * mebibyte });
        engine::print("pt_replay: wrote {}", paths[0].string());
        m.photo.say(fmt::format("wrote {}", paths[0].filename().string()));
    } catch (const FileError& error) {
        say(m, error.what());
    }
}

void change_speed(Replay& replay, double factor)
{
    const double speed = std::copysign(std::clamp(std::abs(replay.speed()) * factor, slowest, fastest), replay.speed());
    replay.play(speed);
}

// ---- the command

void print_help()
{
    engine::print("pt_replay: on and off; pt_replay on, off, info");
    engine::print("pt_replay play [SPEED]: 1 is the game's, 0.25 a quarter of it; -1 backwards");
    engine::print("pt_replay pause");
    engine::print("pt_replay seek SECONDS: from the start; negative: from the end");
    engine::print("pt_replay step [VIEWS]: so many kept views on, or back; 1 if not given");
    engine::print("pt_replay save [NAME]: vkpt/replays/NAME.rtrace, for vkpt render, view and film");
    engine::print("the camera is photo mode's: `pt_photo help`");
}

void print_state(const Module& m)
{
    engine::print("pt_replay: {:.1f} seconds are kept, {} views, {:.2f} MiB", m.replay_ring.seconds(),
        m.replay_ring.views(), double(m.replay_ring.bytes()) / double(mebibyte));
    if (m.replay)
        engine::print("pt_replay: at {:.3f} of {:.3f} seconds, speed {:g}{}", m.replay->place(), m.replay->length(),
            m.replay->speed(), m.replay->is_playing() ? "" : ", paused");
}

void run_save(Module& m)
{
    const std::string name(engine::argument(2));
    if (const std::string wrong = name.empty() ? "" : check_new_name(name); !wrong.empty())
        return say(m, wrong);
    if (m.replay_ring.is_empty())
        return say(m, "there is nothing to save");
    if (cvars::values().pt_photo_save != 0)
        return save_replay(m, name);
    m.replay_name_for_key = name;
    say(m, "press T in the replay to save it; the start option +set pt_photo_save 1 lets the console do it");
}

// `initial` where there is no argument.
std::optional<double> number_argument(double initial)
{
    const std::string_view text = engine::argument(2);
    if (text.empty())
        return initial;
    const std::optional<double> number = parse_number<double>(text);
    if (number && std::abs(*number) < 1e6)
        return number;
    engine::print("pt_replay: \"{}\" is no number", text);
    return std::nullopt;
}

void run_word(Replay& replay, std::string_view word)
{
    if (word == "pause")
        return replay.pause();
    const bool is_play = word == "play", is_seek = word == "seek";
    if (!is_play && !is_seek && word != "step")
        return engine::print("pt_replay: there is no \"{}\"; `pt_replay help` lists all", word);
    const std::optional<double> number = number_argument(is_seek ? 0 : 1);
    if (!number)
        return;
    if (is_play)
        replay.play(std::clamp(*number, -fastest, fastest));
    else if (is_seek)
        replay.seek(*number < 0 ? replay.length() + *number : *number);
    else
        replay.step(int(*number));
}

} // namespace

void keep_for_replay(Module& m, const engine::RefDef& refdef)
{
    const CpuTimer timer("cpu replay");
    const CvarValues& cvars = cvars::values();
    m.replay_ring.add(refdef, { float(cvars.pt_replay_seconds), size_t(cvars.pt_replay_mib) * mebibyte });
}

void run_replay_command(Module& m)
{
    const std::string_view word = engine::argument(1);
    if (word == "help")
        return print_help();
    if (word == "info")
        return print_state(m);
    if (word == "save")
        return run_save(m);
    if (word == "off" || (word.empty() && m.replay))
        return m.replay ? leave_photo_mode(m) : void();
    if (word.empty() || word == "on")
        return m.replay ? void() : enter_replay(m);
    if (!m.replay)
        return engine::print("pt_replay: there is no replay; `pt_replay` shows one, `pt_replay help` lists all");
    run_word(*m.replay, word);
}

void obey_replay_key(Module& m, PhotoKey key)
{
    if (!m.replay)
        return;
    Replay& replay = *m.replay;
    switch (key) {
    case PhotoKey::play:
        return replay.is_playing() ? replay.pause() : replay.play(replay.speed());
    case PhotoKey::reverse:
        return replay.play(-replay.speed());
    case PhotoKey::step_back:
        return replay.step(-1);
    case PhotoKey::step_on:
        return replay.step(1);
    case PhotoKey::slower:
        return change_speed(replay, 0.5);
    case PhotoKey::faster:
        return change_speed(replay, 2);
    case PhotoKey::save_replay:
        return save_replay(m, std::exchange(m.replay_name_for_key, {}));
    default:
        return;
    }
}

std::vector<PanelLine> describe_replay(const Module& m)
{
    if (!m.replay)
        return {};
    const Replay& replay = *m.replay;
    return {
        { "replay", true },
        { fmt::format("{:.2f} of {:.1f} s, {}", replay.place(), replay.length(),
            replay.is_playing() ? fmt::format("speed {:g}", replay.speed()) : "paused") },
        { m.photo.rides() ? "through the player's eyes" : "free camera; home: the player's" },
        { "" },
        { "space, B     plays and pauses, backwards" },
        { ", .          one view back, on" },
        { "- =          slower, faster" },
        { "T            saves the replay" },
        { "" },
    };
}

} // namespace vkpt
