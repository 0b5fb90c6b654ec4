// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/draw_interface.hpp"

#include <SDL.h>
#include <algorithm>
#include <cstddef>
#include <imgui.h>

namespace vkpt::client::view {

namespace {

static_assert(sizeof(SDL_Color) == sizeof(ImU32) && IM_COL32_R_SHIFT == 0 && IM_COL32_A_SHIFT == 24);

SDL_Rect clip_rectangle(const ImVec4& clip, const ImDrawData& data)
{
    const float left = std::max(clip.x - data.DisplayPos.x, 0.0f), top = std::max(clip.y - data.DisplayPos.y, 0.0f);
    const float right = std::min(clip.z - data.DisplayPos.x, data.DisplaySize.x),
                bottom = std::min(clip.w - data.DisplayPos.y, data.DisplaySize.y);
    return { int(left), int(top), int(right - left), int(bottom - top) };
}

void draw_command(SDL_Renderer* renderer, const ImDrawList& list, const ImDrawCmd& command)
{
    const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
    const auto* bytes = reinterpret_cast<const std::byte*>(vertices);
    constexpr int stride = sizeof(ImDrawVert);
    SDL_RenderGeometryRaw(renderer, static_cast<SDL_Texture*>(command.GetTexID()),
        reinterpret_cast<const float*>(bytes + offsetof(ImDrawVert, pos)), stride,
        reinterpret_cast<const SDL_Color*>(bytes + offsetof(ImDrawVert, col)), stride,
        reinterpret_cast<const float*>(bytes + offsetof(ImDrawVert, uv)), stride,
        list.VtxBuffer.Size - int(command.VtxOffset), list.IdxBuffer.Data + command.IdxOffset, int(command.ElemCount),
        int(sizeof(ImDrawIdx)));
}

} // namespace

SDL_Texture* make_font_texture(SDL_Renderer* renderer)
{
    ImGuiIO& io = ImGui::GetIO();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    SDL_Texture* texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
    if (!texture)
        return nullptr;
    SDL_UpdateTexture(texture, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
    SDL_SetTextureScaleMode(texture, SDL_ScaleModeNearest);
    io.Fonts->SetTexID(texture);
    return texture;
}

void draw_interface(SDL_Renderer* renderer, const ImDrawData& data)
{
    SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_BLEND);
    for (int n = 0; n < data.CmdListsCount; n++) {
        const ImDrawList& list = *data.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const SDL_Rect clip = clip_rectangle(command.ClipRect, data);
            if (clip.w <= 0 || clip.h <= 0 || command.ElemCount == 0)
                continue;
            SDL_RenderSetClipRect(renderer, &clip);
            draw_command(renderer, list, command);
        }
    }
    SDL_RenderSetClipRect(renderer, nullptr);
}

} // namespace vkpt::client::view
