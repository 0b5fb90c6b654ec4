// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/key_filter.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

namespace vkpt {

namespace {

// Numbers of SDL 2's and 3's interface, which are the same.
constexpr uint32_t key_down = 0x300, key_up = 0x301, motion = 0x400, button_down = 0x401, button_up = 0x402,
                   wheel = 0x403;

// Where the fields of their events lie.
struct EventLayout {
    size_t scancode, repeat, button, wheel_y, motion_x;
};
constexpr EventLayout layouts[] = { { 16, 13, 16, 20, 28 }, { 24, 37, 24, 28, 36 } }; // SDL 2, SDL 3

template <class Value> Value read(const std::byte* event, size_t offset)
{
    Value value;
    std::memcpy(&value, event + offset, sizeof value);
    return value;
}

// SDL 3 has decimal numbers where SDL 2 has whole ones.
float read_number(const std::byte* event, size_t offset, bool is_sdl3)
{
    return is_sdl3 ? read<float>(event, offset) : float(read<int32_t>(event, offset));
}

constexpr unsigned first_button_code = 512; // behind SDL's scancodes
constexpr unsigned left_button = first_button_code + 1, right_button = first_button_code + 3;

std::optional<MenuKey> menu_key(unsigned code)
{
    switch (code) {
    case 82:
        return MenuKey::up;
    case 81:
        return MenuKey::down;
    case 80:
        return MenuKey::less;
    case 79: // right
    case 40: // return
        return MenuKey::more;
    case left_button:
        return MenuKey::left_button;
    case right_button:
        return MenuKey::right_button;
    case 41: // escape
        return MenuKey::close;
    default:
        return std::nullopt;
    }
}

struct PhotoKeyRow {
    unsigned code;
    PhotoKey key;
};
constexpr PhotoKeyRow photo_keys[] = {
    { 26, PhotoKey::forward }, // W
    { 22, PhotoKey::back }, // S
    { 4, PhotoKey::left }, // A
    { 7, PhotoKey::right }, // D
    { 8, PhotoKey::up }, // E
    { 20, PhotoKey::down }, // Q
    { 29, PhotoKey::roll_left }, // Z
    { 27, PhotoKey::roll_right }, // X
    { 225, PhotoKey::fast }, // left shift
    { 224, PhotoKey::slow }, // left control
    { 82, PhotoKey::brighter }, // up
    { 81, PhotoKey::darker }, // down
    { 79, PhotoKey::wider }, // right
    { 80, PhotoKey::narrower }, // left
    { 9, PhotoKey::focus }, // F
    { left_button, PhotoKey::focus }, { 10, PhotoKey::autofocus }, // G
    { right_button, PhotoKey::autofocus }, { 74, PhotoKey::home }, { 11, PhotoKey::panel }, // H
    { 19, PhotoKey::projection }, // P
    { 40, PhotoKey::save }, // return
    { 44, PhotoKey::play }, // space
    { 5, PhotoKey::reverse }, // B
    { 54, PhotoKey::step_back }, // comma
    { 55, PhotoKey::step_on }, // period
    { 45, PhotoKey::slower }, // minus
    { 46, PhotoKey::faster }, // equals
    { 23, PhotoKey::save_replay }, // T
    { 41, PhotoKey::close }, // escape
};

std::optional<PhotoKey> photo_key(unsigned code)
{
    const auto* row = std::ranges::find(photo_keys, code, &PhotoKeyRow::code);
    return row != std::end(photo_keys) ? std::optional(row->key) : std::nullopt;
}

template <class Function> Function sdl_function(const char* name)
{
    return reinterpret_cast<Function>(engine::symbol(name));
}

} // namespace

void KeyFilter::install()
{
    if (is_installed_)
        return;
    if (engine::sdl_major() >= 3) {
        const auto set = sdl_function<void (*)(bool (*)(void*, void*), void*)>("SDL_SetEventFilter");
        const auto get = sdl_function<bool (*)(Filter*, void**)>("SDL_GetEventFilter");
        if (!set || !get)
            return;
        get(&next_, &next_context_);
        set(filter3, this);
    } else {
        const auto set = sdl_function<void (*)(Filter, void*)>("SDL_SetEventFilter");
        const auto get = sdl_function<int (*)(Filter*, void**)>("SDL_GetEventFilter");
        if (!set || !get)
            return;
        get(&next_, &next_context_);
        set(filter, this);
    }
    is_installed_ = true;
}

KeyFilter::~KeyFilter()
{
    if (is_installed_)
        sdl_function<void (*)(Filter, void*)>("SDL_SetEventFilter")(next_, next_context_);
}

int KeyFilter::filter(void* context, void* event)
{
    auto& self = *static_cast<KeyFilter*>(context);
    if (!self.passes(static_cast<const std::byte*>(event)))
        return 0;
    return self.next_ ? self.next_(self.next_context_, event) : 1;
}

bool KeyFilter::filter3(void* context, void* event)
{
    auto& self = *static_cast<KeyFilter*>(context);
    if (!self.passes(static_cast<const std::byte*>(event)))
        return false;
    // It returns one byte.
    return !self.next_ || (self.next_(self.next_context_, event) & 0xff) != 0;
}

void KeyFilter::set_user(KeyUser user)
{
    if (user == user_)
        return;
    const std::scoped_lock lock(mutex_);
    user_ = user;
    menu_.clear();
    menu_wheel_ = 0;
    photo_ = {};
}

// Whether it is kept from the engine. A key that was held when the menu opened is let go for the engine, too.
bool KeyFilter::press(unsigned code, bool down)
{
    if (code >= held_.size())
        return false;
    const std::scoped_lock lock(mutex_);
    const auto for_menu = menu_key(code);
    const auto for_photo = photo_key(code);
    if (!down) {
        const bool was_held = held_[code];
        held_[code] = false;
        if (for_photo)
            photo_.held[size_t(*for_photo)] = false;
        return was_held;
    }
    const bool is_kept = (user_ == KeyUser::menu && for_menu) || (user_ == KeyUser::photo && for_photo);
    if (!is_kept)
        return false;
    if (user_ == KeyUser::menu) {
        press_in_menu(*for_menu);
    } else {
        photo_.pressed.push_back(*for_photo);
        photo_.held[size_t(*for_photo)] = true;
    }
    held_[code] = true;
    return true;
}

// It goes where the press went, and does nothing here: a slow frame would send many, and the key that opened the menu
// is still held.
bool KeyFilter::repeat(unsigned code)
{
    const std::scoped_lock lock(mutex_);
    return code < held_.size() && held_[code];
}

bool KeyFilter::turn_wheel(float notches)
{
    const std::scoped_lock lock(mutex_);
    if (user_ == KeyUser::photo)
        photo_.wheel += notches;
    else if (user_ == KeyUser::menu)
        for (menu_wheel_ += notches; std::abs(menu_wheel_) >= 1; menu_wheel_ -= std::copysign(1.0f, menu_wheel_))
            press_in_menu(menu_wheel_ > 0 ? MenuKey::up : MenuKey::down);
    return user_ != KeyUser::engine;
}

bool KeyFilter::move_mouse(glm::vec2 pixels)
{
    const std::scoped_lock lock(mutex_);
    if (user_ == KeyUser::photo) {
        photo_.mouse += pixels;
    } else if (user_ == KeyUser::menu) {
        if (menu_.empty() || menu_.back().key)
            menu_.emplace_back();
        menu_.back().mouse += pixels;
    }
    return user_ != KeyUser::engine;
}

void KeyFilter::press_in_menu(MenuKey key)
{
    if (menu_.empty() || menu_.back().key)
        menu_.emplace_back();
    menu_.back().key = key;
}

bool KeyFilter::passes(const std::byte* event)
{
    const bool is_sdl3 = engine::sdl_major() >= 3;
    const EventLayout& layout = layouts[is_sdl3];
    const uint32_t type = read<uint32_t>(event, 0);
    switch (type) {
    case key_down:
        if (read<uint8_t>(event, layout.repeat) != 0)
            return !repeat(read<uint32_t>(event, layout.scancode));
        [[fallthrough]];
    case key_up:
        return !press(read<uint32_t>(event, layout.scancode), type == key_down);
    case button_down:
    case button_up:
        return !press(first_button_code + read<uint8_t>(event, layout.button), type == button_down);
    case wheel:
        return !turn_wheel(read_number(event, layout.wheel_y, is_sdl3));
    case motion:
        return !move_mouse({ read_number(event, layout.motion_x, is_sdl3),
            read_number(event, layout.motion_x + sizeof(float), is_sdl3) });
    default:
        return true;
    }
}

std::vector<MenuInput> KeyFilter::take_menu_input()
{
    const std::scoped_lock lock(mutex_);
    return std::exchange(menu_, {});
}

PhotoInput KeyFilter::take_photo_input()
{
    const std::scoped_lock lock(mutex_);
    PhotoInput input = photo_;
    photo_.pressed.clear();
    photo_.mouse = glm::vec2(0);
    photo_.wheel = 0;
    return input;
}

} // namespace vkpt
