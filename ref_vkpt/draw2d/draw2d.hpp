// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer: collects rectangles in the order of the engine's calls and blends them over the output image.
// Positions and sizes are in pixels of the output image, y down. Colours are display values: nothing is linearised.
#pragma once

#include "ref_vkpt/scene/textures.hpp"
#include "ref_vkpt/vulkan/pipelines.hpp"
#include "shaders/shared/quad.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vkpt {

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
};

// How the player wants 2D images sampled; from the cvars r_2D_unfiltered, r_videos_unfiltered, r_nolerp_list,
// r_lerp_list.
struct Filtering {
    bool unfiltered_images = false;
    bool unfiltered_videos = false;
    std::string never_filtered; // paths in one text
    std::string always_filtered; // exceptions to unfiltered_images
};

// How bright 2D is shown: a colour c as (c * intensity)^(1 / gamma), as Yamagi's OpenGL 3 renderer does. From the cvars
// gl3_intensity_2D and vid_gamma.
struct Brightness {
    float intensity = 1, gamma = 1;
};

class Draw2d {
public:
    Draw2d(const Gpu& gpu, Bindings& bindings, Pipelines& pipelines, TextureStore& textures, uint32_t frames);
    ~Draw2d();
    Draw2d(const Draw2d&) = delete;
    Draw2d& operator=(const Draw2d&) = delete;

    // The image to draw on (see OutputImage). Call on every resize.
    void set_output(VkDeviceAddress words, VkExtent2D size);

    // The device has finished the last frame with this index; its memory is used again.
    void begin_frame(uint32_t frame_slot, const Filtering& filtering, const Brightness& brightness);

    // `tint_rgb`: three factors 0..1; nullptr: none.
    void draw_pic(const Texture& texture, int x, int y, float scale, const float* tint_rgb = nullptr);
    void draw_stretched(const Texture& texture, const Rectangle& place);
    // A character of pics/conchars.pcx, 8 x 8 pixels times `scale`; only the low 8 bits of the code count.
    void draw_character(int x, int y, int code, float scale);
    // The image repeated every 64 pixels, fixed to the screen's corner.
    void draw_tiled(const Texture& texture, const Rectangle& place);
    // Index into the game's palette.
    void draw_fill(const Rectangle& place, int palette_index);
    // Darkens everything drawn so far.
    void draw_fade();
    void draw_shade(const Rectangle& place); // there alone
    // A video frame: `bits` 8 (palette of set_palette) or 32 (RGBA, alpha ignored). The pixels are copied now.
    void draw_raw(const Rectangle& place, int columns, int rows, const uint8_t* pixels, int bits);
    // RGB triples of 256 entries for draw_raw; nullptr: the game's palette.
    void set_palette(const uint8_t* rgb);

    bool empty() const { return quads_.empty(); }
    // Draws what was collected since the last call, in as many calls a frame as wanted. Waits for compute, transfer and
    // drawing that touched the output before, and makes what it wrote visible to the same afterwards.
    void record(VkCommandBuffer commands);

private:
    struct RawImage { // a video frame on the device
        Image image;
        uint32_t slot = 0;
    };
    struct RawCopy {
        size_t image;
        Buffer staging;
    };
    struct FrameMemory {
        Buffer lists;
        VkDeviceSize used = 0;
        std::vector<Buffer> retired;
        std::vector<RawImage> retired_images;
    };

    uint32_t choose_sampler(const Texture& texture) const;
    void add_quad(const Texture& texture, glm::vec2 low, glm::vec2 high, uint32_t color = 0xffffffff);
    void add_plain_quad(glm::vec2 low, glm::vec2 high, uint32_t color);
    size_t prepare_raw_image(int columns, int rows);
    void sort_into_tiles();
    shared::QuadPush upload_lists();
    void record_raw_copies(VkCommandBuffer commands);

    Gpu gpu_;
    Bindings& bindings_;
    TextureStore& textures_;
    Pipelines& pipelines_;
    VkDeviceAddress output_ = 0;
    VkExtent2D size_ {}; // of the output

    Filtering filtering_;
    Brightness brightness_;
    std::vector<shared::Quad> quads_;
    // Made from quads_ by sort_into_tiles(); kept for their memory.
    std::vector<shared::QuadTile> tiles_;
    std::vector<uint32_t> quad_indices_;
    std::vector<uint32_t> ends_; // of each tile's part of quad_indices_, while sorting
    std::vector<uint32_t> lowest_; // the first quad that can be seen in each tile

    std::vector<FrameMemory> frames_;
    size_t frame_ = 0;

    std::optional<std::array<uint32_t, 256>> video_palette_; // RGBA8, opaque
    std::vector<RawImage> raw_images_;
    size_t raw_images_used_ = 0; // this frame
    std::vector<RawCopy> raw_copies_;
};

} // namespace vkpt
