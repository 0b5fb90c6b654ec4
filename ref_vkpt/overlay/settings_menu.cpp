// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/settings_menu.hpp"

#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/preset_command.hpp"
#include "ref_vkpt/presets.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace vkpt {

namespace {

struct Row {
    const char *label, *cvar; // cvar nullptr: the preset
    double step = 0; // of numbers
    double lowest = 0, highest = 0; // of the engine's; ours have theirs in cvars.def
};
constexpr Row rows[] = {
    { "preset", nullptr },
    { "light sampler", "pt_light_sampler" },
    { "bounces", "pt_bounces", 1 },
    { "bounce rays", "pt_bounce_pixels" },
    { "noise filter", "flt_denoiser" },
    { "anti-aliasing", "flt_taa" },
    { "render scale, %", "pt_render_scale", 5 },
    { "wanted ms, or 0", "pt_target_ms", 5 },
    { "brightness, stops", "pt_exposure_bias", 0.25 },
    { "gamma", "vid_gamma", 0.1, 0.1, 2 },
    { "glow", "pt_bloom", 0.02 },
    { "least light", "pt_min_light", 0.01 },
    { "own body", "pt_player_body", 1 },
    { "times on screen", "pt_show_times", 1 },
};
constexpr bool all_known()
{
    return std::ranges::all_of(rows, [](const Row& row) { return !row.cvar || find_cvar_row(row.cvar); });
}
static_assert(all_known());

constexpr size_t lines_above = 2; // the first row

std::string cvar_text(const char* cvar)
{
    const engine::Cvar* found = engine::get_cvar(cvar, find_cvar_row(cvar)->initial, engine::CVAR_NONE);
    return found && found->text ? found->text : "";
}

std::vector<std::string> choices_of(const Row& row)
{
    std::vector<std::string> choices;
    if (!row.cvar) {
        for (const Preset& preset : presets())
            choices.push_back(preset.name);
    } else if (std::string_view(row.cvar) == "pt_light_sampler") {
        for (const LightSampler& sampler : light_samplers())
            choices.emplace_back(sampler.name);
    } else {
        std::string_view rest = find_cvar_row(row.cvar)->choices;
        while (!rest.empty()) {
            const size_t end = std::min(rest.find('|'), rest.size());
            choices.emplace_back(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    }
    return choices;
}

std::string value_of(const Row& row)
{
    if (!row.cvar)
        return std::string(current_preset());
    if (row.step == 0)
        return cvar_text(row.cvar);
    return fmt::format("{:g}", std::round(std::atof(cvar_text(row.cvar).c_str()) * 1000) / 1000);
}

void step_choice(const Row& row, int direction)
{
    const std::vector<std::string> choices = choices_of(row);
    const auto now = std::ranges::find(choices, value_of(row));
    const auto count = std::ptrdiff_t(choices.size());
    // From what is none of them, to the first.
    const std::ptrdiff_t next = now == choices.end() ? 0 : (now - choices.begin() + direction + count) % count;
    if (row.cvar)
        engine::set_cvar(row.cvar, choices[size_t(next)]);
    else
        apply_preset(*find_preset(choices[size_t(next)]));
}

void step_number(const Row& row, int direction)
{
    const CvarRow& about = *find_cvar_row(row.cvar);
    const bool ours = about.owner == CvarOwner::module;
    const double lowest = ours ? about.lowest : row.lowest, highest = ours ? about.highest : row.highest;
    const double now = std::atof(cvar_text(row.cvar).c_str());
    // To the next of the steps' own places, from wherever it stands.
    constexpr double same = 1e-3; // steps: texts of numbers are rounded
    const double steps = now / row.step;
    const double next = direction > 0 ? std::floor(steps + same) + 1 : std::ceil(steps - same) - 1;
    engine::set_cvar(row.cvar, fmt::format("{:g}", std::clamp(next * row.step, lowest, highest)));
}

} // namespace

SettingsMenu::SettingsMenu()
    : times_(frames_in_flight)
{
}

void SettingsMenu::toggle()
{
    is_open_ = !is_open_;
    times_.forget_changes();
}

bool SettingsMenu::choose_line(size_t line)
{
    if (line < lines_above || line >= lines_above + std::size(rows))
        return false;
    row_ = line - lines_above;
    return true;
}

size_t SettingsMenu::chosen_line() const { return lines_above + row_; }

void SettingsMenu::change(int direction)
{
    times_.note_change(row_);
    const Row& row = rows[row_];
    if (row.step == 0)
        step_choice(row, direction);
    else
        step_number(row, direction);
}

void SettingsMenu::press(MenuKey key)
{
    switch (key) {
    case MenuKey::up:
        row_ = (row_ + std::size(rows) - 1) % std::size(rows);
        break;
    case MenuKey::down:
        row_ = (row_ + 1) % std::size(rows);
        break;
    case MenuKey::less:
    case MenuKey::right_button:
        change(-1);
        break;
    case MenuKey::more:
    case MenuKey::left_button:
        change(1);
        break;
    case MenuKey::close:
        toggle();
        break;
    }
}

// Beside a row that was changed.
std::string SettingsMenu::describe_change(size_t row) const
{
    const std::optional<ChangeTimes::Pair> times = times_.find(row);
    if (!times || times->before <= 0) // the device has no clock
        return {};
    return times->after > 0 ? fmt::format(" {:5.1f} > {:.1f} ms", times->before, times->after)
                            : fmt::format(" {:5.1f} > ... ms", times->before);
}

std::vector<PanelLine> SettingsMenu::describe(bool is_covered) const
{
    std::vector<PanelLine> lines(lines_above);
    lines[0] = { "path tracing", true };
    for (size_t i = 0; i < std::size(rows); i++)
        lines.push_back({ fmt::format("{} {:17} {:>15}{}", i == row_ ? '>' : ' ', rows[i].label, value_of(rows[i]),
                              describe_change(i)),
            i == row_ });
    lines.push_back({ "" });
    lines.push_back({ fmt::format(
        "frame {:.1f} ms{}", times_.newest(), times_.empty() ? "" : "; beside a change: before > after") });
    lines.push_back({ is_covered ? "keys: the console's or the menu's" : "arrows or mouse, escape: close" });
    return lines;
}

} // namespace vkpt
