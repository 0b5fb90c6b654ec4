// SPDX-License-Identifier: GPL-2.0-or-later
// Dear ImGui's triangles through SDL's renderer; Debian's library brings the input half of that backend only.
#pragma once

struct ImDrawData;
struct SDL_Renderer;
struct SDL_Texture;

namespace vkpt::client::view {

// The interface's font, known to Dear ImGui from then on. The caller destroys it. nullptr: SDL_GetError says why.
SDL_Texture* make_font_texture(SDL_Renderer* renderer);

void draw_interface(SDL_Renderer* renderer, const ImDrawData& data);

} // namespace vkpt::client::view
