// SPDX-License-Identifier: GPL-2.0-or-later
// The renderer as a list of verbs. engine/exports.cpp translates the engine's calls into these; nothing else calls
// them. Handles are pointers to Model, Skin image (Texture) and so on that live until the registration after the one
// that stopped using them.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace vkpt::renderer {

// The rectangle sizes of 2D calls are in window pixels.

// Window flags for the engine's SDL window, or -1.
int prepare_for_window();
// Creates device and swapchain; `window` is the engine's SDL_Window, nullptr: no window, images only.
// False after having told the console why.
bool init_context(void* sdl_window);
void shutdown_context();
// Registers cvars and commands; asks the engine for its window (which calls the two above).
bool init();
void shutdown();
bool is_vsync_active();
void get_drawable_size(int* width, int* height);
// Where the device was when it was lost, with which settings, and what to do about it.
std::string describe_lost_device();

void begin_registration(std::string_view map);
void* register_model(std::string_view name);
void* register_skin(std::string_view name);
void set_sky(std::string_view name, float rotate_degrees_per_second, const float axis[3]);
void end_registration();

void begin_frame(float camera_separation);
void render_view(const engine::RefDef& refdef);
void end_frame();
// Called in frames without a 3D view before 2D starts.
bool end_world_renderpass();

void* find_pic(std::string_view name);
void get_pic_size(std::string_view name, int* width, int* height); // -1, -1: missing
void draw_pic(int x, int y, std::string_view name, float scale, const float* tint_rgb_or_null);
void draw_stretched_pic(int x, int y, int width, int height, std::string_view name);
void draw_character(int x, int y, int code, float scale);
void draw_tiled(int x, int y, int width, int height, std::string_view name);
void draw_fill(int x, int y, int width, int height, int palette_index);
void draw_fade();
// bits: 8 (palette of set_palette) or 32 (RGBA)
void draw_raw(int x, int y, int width, int height, int columns, int rows, const uint8_t* pixels, int bits);
// RGB triples of 256 entries; nullptr: back to the game's own
void set_palette(const uint8_t* rgb_or_null);

} // namespace vkpt::renderer
