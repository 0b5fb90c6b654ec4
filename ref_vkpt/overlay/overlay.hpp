// SPDX-License-Identifier: GPL-2.0-or-later
// What this renderer draws over the game's own image: pt_show_times, pt_menu, pt_show_lights, pt_show_material, and
// errors in shaders that are edited.
#pragma once

#include "ref_vkpt/overlay/engine_screen.hpp"
#include "ref_vkpt/overlay/settings_menu.hpp"
#include "ref_vkpt/overlay/times_lines.hpp"

#include <glm/vec2.hpp>
#include <optional>

namespace vkpt {

struct OverlayFacts {
    VkExtent2D window;
    glm::uvec2 rendered; // pixels of the 3D view
    double frame_milliseconds; // on the device
    const std::vector<PassTime>* passes;
    const std::vector<std::string>* shader_errors; // see ShaderReload
    std::vector<PanelLine> photo; // photo mode's panel
    std::vector<PanelLine> lights; // pt_show_lights
    std::vector<PanelLine> material; // pt_show_material
};

class Overlay {
public:
    // In the life of the engine's window.
    void take_keys() { keys_.install(); }
    void toggle_menu();
    // Between frames.
    void obey_input(VkExtent2D window);
    // A view was shown whose frame had taken so long on the device.
    void note_frame(double milliseconds) { menu_.note_frame(milliseconds); }
    // Whether keys and mouse are photo mode's, unless the menu is open or the engine has them.
    void give_keys_to_photo(bool give);
    PhotoInput take_photo_input() { return keys_.take_photo_input(); }
    // Last of all 2D.
    void draw(Draw2d& draw2d, const OverlayFacts& facts);

    EngineScreen engine_screen;

private:
    void choose_key_user();
    static std::vector<PanelLine> describe_surface(const OverlayFacts& facts);
    std::vector<PanelLine> describe_menu() const { return menu_.describe(engine_screen.had_keys()); }
    void move_pointer(glm::vec2 way, VkExtent2D window);
    void obey(const MenuInput& input, VkExtent2D window);
    std::vector<PanelLine> describe_times(const OverlayFacts& facts) const;

    FrameRate rate_;
    SettingsMenu menu_;
    std::optional<glm::vec2> pointer_; // on the menu, in the window's pixels, once the mouse has been moved
    KeyFilter keys_;
    bool photo_has_keys_ = false;
};

} // namespace vkpt
