// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/theme.hpp"

#include <filesystem>
#include <iterator>

namespace vkpt::client::view {

namespace {

constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float font_size = 15;

ImVec4 grey(float value, float alpha = 1) { return { value * 0.96f, value, value * 1.06f, alpha }; }

} // namespace

void apply_theme()
{
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = 0;
    style.WindowBorderSize = 0;
    style.WindowPadding = { 12, 10 };
    style.FramePadding = { 7, 4 };
    style.ItemSpacing = { 8, 5 };
    style.CellPadding = { 4, 2 };
    style.ScrollbarSize = 12;
    // What the CPU draws is quicker and crisper without.
    style.AntiAliasedLines = style.AntiAliasedFill = style.AntiAliasedLinesUseTex = false;
    ImVec4* colours = style.Colors;
    colours[ImGuiCol_WindowBg] = grey(0.09f);
    colours[ImGuiCol_PopupBg] = grey(0.12f);
    colours[ImGuiCol_TitleBg] = colours[ImGuiCol_TitleBgActive] = grey(0.16f);
    colours[ImGuiCol_Text] = grey(0.93f);
    colours[ImGuiCol_TextDisabled] = grey(0.65f);
    colours[ImGuiCol_FrameBg] = grey(0.19f);
    colours[ImGuiCol_FrameBgHovered] = grey(0.26f);
    colours[ImGuiCol_FrameBgActive] = grey(0.30f);
    colours[ImGuiCol_Button] = grey(0.22f);
    colours[ImGuiCol_ButtonHovered] = grey(0.32f);
    colours[ImGuiCol_ButtonActive] = grey(0.38f);
    colours[ImGuiCol_Header] = grey(0.16f);
    colours[ImGuiCol_HeaderHovered] = grey(0.24f);
    colours[ImGuiCol_HeaderActive] = grey(0.28f);
    colours[ImGuiCol_SliderGrab] = grey(0.62f);
    colours[ImGuiCol_SliderGrabActive] = grey(0.85f);
    colours[ImGuiCol_CheckMark] = grey(0.93f);
    colours[ImGuiCol_Separator] = grey(0.24f);
    colours[ImGuiCol_ScrollbarBg] = grey(0.09f);
    colours[ImGuiCol_ScrollbarGrab] = grey(0.28f);
    colours[ImGuiCol_TableHeaderBg] = grey(0.16f);
    colours[ImGuiCol_TableRowBgAlt] = grey(0.5f, 0.06f);
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    std::error_code ignored;
    if (std::filesystem::exists(font_file, ignored))
        fonts.AddFontFromFileTTF(font_file, font_size);
    else
        fonts.AddFontDefault();
}

// Neighbours differ in hue and lightness, so that colour-blind eyes tell them apart.
ImU32 series_colour(size_t n)
{
    constexpr ImU32 colours[] = { IM_COL32(86, 180, 233, 255), IM_COL32(230, 159, 0, 255), IM_COL32(0, 158, 115, 255),
        IM_COL32(240, 228, 66, 255), IM_COL32(0, 114, 178, 255), IM_COL32(213, 94, 0, 255),
        IM_COL32(204, 121, 167, 255), IM_COL32(170, 170, 170, 255), IM_COL32(120, 94, 240, 255),
        IM_COL32(150, 210, 120, 255) };
    return colours[n % std::size(colours)];
}

} // namespace vkpt::client::view
