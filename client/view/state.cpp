// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/state.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt::client::view {

void set_value(State& state, Side side, const std::string& name, const std::string& value)
{
    std::string& current = state.side(side).settings[name];
    if (current == value)
        return;
    current = value;
    state.side(side).passes.clear();
    state.side(side).errors = {};
    state.must_inspect |= state.marked.has_value();
}

const std::string& value_of(const State& state, Side side, std::string_view name)
{
    static const std::string none;
    const auto found = state.side(side).settings.find(name);
    return found == state.side(side).settings.end() ? none : found->second;
}

void show_notice(State& state, std::string text, bool is_bad)
{
    state.notice = std::move(text);
    state.notice_is_bad = is_bad;
    state.notice_time = Clock::now();
}

bool does_time_pass(const State& state)
{
    const auto averages = [&](Side side) { return value_of(state, side, "pt_accumulate") == "1"; };
    return state.plays && !state.has_reference && !averages(Side::a) && !(state.split.is_on && averages(Side::b));
}

void show_frame(State& state, int frame)
{
    state.frame = std::max(frame, 0);
    if (!state.is_endless())
        state.frame = std::min(state.frame, state.last_frame());
}

Side side_at(const State& state, glm::ivec2 pixel)
{
    return pixel.x < state.split.columns_of_a(state.picture_size().x) ? Side::a : Side::b;
}

void mark_pixel(State& state, glm::ivec2 pixel)
{
    state.marked = pixel;
    state.inspected_side = side_at(state, pixel);
    state.must_inspect = true;
}

std::string describe_side(const State& state, Side side)
{
    std::string text = fmt::format("{}  R {}  {}", value_of(state, side, "pt_light_sampler"),
        value_of(state, side, "pt_light_subset"), value_of(state, side, "flt_denoiser"));
    if (!state.split.is_on)
        return text;
    const Side other = side == Side::a ? Side::b : Side::a;
    for (const LiveSetting& setting : state.live) {
        const bool is_told
            = setting.name == "pt_light_sampler" || setting.name == "pt_light_subset" || setting.name == "flt_denoiser";
        const std::string& value = value_of(state, side, setting.name);
        if (!is_told && value != value_of(state, other, setting.name))
            text += fmt::format("  {} {}", setting.name, value);
    }
    return text;
}

std::string describe_title(const State& state)
{
    std::string title = fmt::format("vkpt view - {} - A: {}", state.scene, describe_side(state, Side::a));
    if (state.split.is_on)
        title += fmt::format(" | B: {}", describe_side(state, Side::b));
    return title;
}

} // namespace vkpt::client::view
