// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/overlay.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/overlay/wrap_line.hpp"
#include "ref_vkpt/preset_command.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

namespace vkpt {

void Overlay::toggle_menu()
{
    menu_.toggle();
    pointer_.reset();
    choose_key_user();
}

void Overlay::choose_key_user()
{
    keys_.set_user(engine_screen.had_keys() ? KeyUser::engine
            : menu_.is_open()               ? KeyUser::menu
            : photo_has_keys_               ? KeyUser::photo
                                            : KeyUser::engine);
}

void Overlay::give_keys_to_photo(bool give)
{
    photo_has_keys_ = give;
    choose_key_user();
}

// From the chosen row on.
void Overlay::move_pointer(glm::vec2 way, VkExtent2D window)
{
    const std::vector<PanelLine> lines = describe_menu();
    const glm::vec2 from = pointer_.value_or(end_of_line(window, PanelSide::left, lines, menu_.chosen_line()));
    pointer_ = glm::clamp(from + way, glm::vec2(0), glm::vec2(window.width, window.height) - 1.0f);
    if (const std::optional<size_t> line = find_line(window, PanelSide::left, lines, *pointer_))
        menu_.choose_line(*line);
}

void Overlay::obey(const MenuInput& input, VkExtent2D window)
{
    if (input.mouse != glm::vec2(0))
        move_pointer(input.mouse, window);
    if (!input.key)
        return;
    const bool is_button = *input.key == MenuKey::left_button || *input.key == MenuKey::right_button;
    if (is_button && pointer_) { // what is under it
        const std::optional<size_t> line = find_line(window, PanelSide::left, describe_menu(), *pointer_);
        if (!line || !menu_.choose_line(*line))
            return;
    }
    menu_.press(*input.key);
}

void Overlay::obey_input(VkExtent2D window)
{
    engine_screen.begin_frame();
    choose_key_user();
    for (const MenuInput& input : keys_.take_menu_input())
        if (menu_.is_open())
            obey(input, window);
    if (!menu_.is_open())
        pointer_.reset();
    choose_key_user();
}

static std::vector<PanelLine> describe_shader_errors(const std::vector<std::string>& errors, size_t columns)
{
    std::vector<PanelLine> lines;
    for (const std::string& error : errors)
        for (const std::string& part : wrap_line(error, columns))
            lines.push_back({ part, &error == &errors.front() });
    return lines;
}

std::vector<PanelLine> Overlay::describe_times(const OverlayFacts& facts) const
{
    const CvarValues& cvars = cvars::values();
    std::vector<PanelLine> lines {
        { fmt::format("{:.1f} fps, {:.1f} ms on the device", rate_.frames_per_second(), facts.frame_milliseconds) },
        { fmt::format("{} x {} of {} x {}, preset {}", facts.rendered.x, facts.rendered.y, facts.window.width,
            facts.window.height, current_preset()) },
        { fmt::format("{}, bounces {}", cvars.pt_light_sampler, cvars.pt_bounces) },
        { fmt::format("{}, taa {}", cvars.flt_denoiser, cvars.flt_taa) },
    };
    if (cvars.pt_show_times > 1) {
        lines.push_back({ "" });
        const std::vector<PanelLine> passes = describe_passes(*facts.passes);
        lines.insert(lines.end(), passes.begin(), passes.end());
    }
    return lines;
}

// What is under the crosshair, and what lights it.
std::vector<PanelLine> Overlay::describe_surface(const OverlayFacts& facts)
{
    std::vector<PanelLine> lines = facts.material;
    if (!lines.empty() && !facts.lights.empty())
        lines.push_back({ "" });
    lines.insert(lines.end(), facts.lights.begin(), facts.lights.end());
    return lines;
}

void Overlay::draw(Draw2d& draw2d, const OverlayFacts& facts)
{
    rate_.count(FrameRate::Clock::now());
    if (cvars::values().pt_show_times > 0)
        draw_panel(draw2d, facts.window, PanelSide::right, describe_times(facts));
    if (menu_.is_open())
        draw_panel(draw2d, facts.window, PanelSide::left, describe_menu());
    else if (!facts.shader_errors->empty())
        draw_panel(draw2d, facts.window, PanelSide::left,
            describe_shader_errors(*facts.shader_errors, panel_columns(facts.window)));
    else
        draw_panel(draw2d, facts.window, PanelSide::left, facts.photo.empty() ? describe_surface(facts) : facts.photo);
    if (pointer_ && !engine_screen.had_keys())
        draw_pointer(draw2d, facts.window, *pointer_);
}

} // namespace vkpt
