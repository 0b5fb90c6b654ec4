// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/trace_info.hpp"

#include "common/trace/trace_reader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;
using trace::Call;
using trace::CallKind;

constexpr int trace_info_schema = 1;

uint64_t join(int32_t low, int32_t high) { return uint64_t(uint32_t(low)) | uint64_t(uint32_t(high)) << 32; }

void add_facts(Json& info, const std::vector<Call>& facts)
{
    info["facts"] = Json::object();
    info["files"] = Json::array();
    for (const Call& call : facts) {
        if (call.kind == CallKind::fact)
            info["facts"][call.name] = call.text;
        if (call.kind == CallKind::screen)
            info["window"] = { call.numbers[0], call.numbers[1] };
        if (call.kind == CallKind::file)
            info["files"].push_back({ { "name", call.name }, { "bytes", join(call.numbers[0], call.numbers[1]) },
                { "hash", fmt::format("{:016x}", join(call.numbers[2], call.numbers[3])) } });
    }
}

void add_registrations(Json& info, const trace::TraceReader& reader)
{
    info["maps"] = Json::array();
    size_t models = 0, skins = 0;
    for (const trace::LastingCall& lasting : reader.lasting_calls()) {
        models += lasting.call.kind == CallKind::register_model;
        skins += lasting.call.kind == CallKind::register_skin;
        if (lasting.call.kind == CallKind::begin_registration)
            info["maps"].push_back({ { "map", lasting.call.name }, { "frame", lasting.frame } });
        if (lasting.call.kind == CallKind::setting)
            info["settings"][lasting.call.name] = lasting.call.text;
    }
    info["model_registrations"] = models;
    info["skin_registrations"] = skins;
}

} // namespace

Json make_trace_info(const std::filesystem::path& path)
{
    const trace::TraceReader reader(path);
    const size_t frames = reader.frame_count();
    Json info;
    info["schema"] = trace_info_schema;
    info["trace"] = path.string();
    info["version"] = trace::file_version;
    info["bytes"] = reader.file_bytes();
    info["whole"] = reader.cut_at() == 0;
    if (reader.cut_at())
        info["cut_at"] = reader.cut_at();
    info["frames"] = frames;
    info["seconds"] = frames ? reader.seconds(frames - 1) : 0.0;
    info["calls"] = reader.totals().calls;
    info["frames_with_2d_only"] = reader.totals().frames - std::min<uint32_t>(reader.totals().frames, uint32_t(frames));
    add_facts(info, reader.facts());
    add_registrations(info, reader);
    const trace::TraceReader::Most& most = reader.most();
    info["max_at_once"]
        = { { "entities", most.entities }, { "dlights", most.dlights }, { "particles", most.particles } };
    return info;
}

void print_trace_info(const Json& info)
{
    const auto line = [](const std::string& name, const std::string& value) { fmt::print("{:<16}{}\n", name, value); };
    const double seconds = info["seconds"], bytes = info["bytes"];
    line("trace", info["trace"]);
    line("size",
        fmt::format("{:.0f} kB, {:.1f} kB a second, {}", bytes / 1000, bytes / 1000 / std::max(seconds, 1e-3),
            info["whole"].get<bool>() ? "whole" : fmt::format("cut off at byte {}", info["cut_at"].dump())));
    line("frames",
        fmt::format("{} in {:.1f} s, and {} of 2D only; {} calls", info["frames"].dump(), seconds,
            info["frames_with_2d_only"].dump(), info["calls"].dump()));
    if (info.contains("window"))
        line("window", fmt::format("{} x {}", info["window"][0].dump(), info["window"][1].dump()));
    for (const Json& map : info["maps"])
        line("map", fmt::format("{}, from frame {} on", map["map"].get<std::string>(), map["frame"].dump()));
    line("registered",
        fmt::format("{} models, {} skins", info["model_registrations"].dump(), info["skin_registrations"].dump()));
    const Json& most = info["max_at_once"];
    line("most at once",
        fmt::format("{} entities, {} dynamic lights, {} particles", most["entities"].dump(), most["dlights"].dump(),
            most["particles"].dump()));
    line("files", fmt::format("{} (--json lists them with their hashes)", info["files"].size()));
    for (const auto& [name, value] : info["facts"].items())
        line(name, value.get<std::string>());
    if (info.contains("settings"))
        for (const auto& [name, value] : info["settings"].items())
            line(name, value.get<std::string>());
}

} // namespace vkpt::client
