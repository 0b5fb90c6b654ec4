// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/key_filter.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <cstring>
#include <optional>
#include <utility>

namespace vkpt {

namespace {

// Numbers of SDL 2's and 3's interface, which are the same.
constexpr uint32_t key_down = 0x300, key_up = 0x301, button_down = 0x401, button_up = 0x402, wheel = 0x403;

// Where the fields of their events lie.
struct EventLayout {
    size_t scancode, button, wheel_y;
};
constexpr EventLayout layouts[] = { { 16, 16, 20 }, { 24, 24, 28 } }; // SDL 2, SDL 3

template <class Value> Value read(const std::byte* event, size_t offset)
{
    Value value;
    std::memcpy(&value, event + offset, sizeof value);
    return value;
}

std::optional<MenuKey> key_of(uint32_t scancode)
{
    switch (scancode) {
    case 82:
        return MenuKey::up;
    case 81:
        return MenuKey::down;
    case 80:
        return MenuKey::less;
    case 79: // right
    case 40: // return
        return MenuKey::more;
    case 41: // escape
        return MenuKey::close;
    default:
        return std::nullopt;
    }
}

std::optional<MenuKey> key_of_button(uint8_t button)
{
    return button == 1 ? std::optional(MenuKey::more) : button == 3 ? std::optional(MenuKey::less) : std::nullopt;
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

// Whether it is kept from the engine. A key that was held when the menu opened is let go for the engine, too.
bool KeyFilter::press(MenuKey key, unsigned code, bool down)
{
    const std::scoped_lock lock(mutex_);
    if (!down) {
        const bool was_held = held_[code];
        held_[code] = false;
        return was_held;
    }
    if (!is_open_)
        return false;
    if (!held_[code]) // no repetitions: a slow frame would send many
        pressed_.push_back(key);
    held_[code] = true;
    return true;
}

bool KeyFilter::passes(const std::byte* event)
{
    constexpr unsigned first_button_code = 512; // behind SDL's scancodes
    const bool is_sdl3 = engine::sdl_major() >= 3;
    const EventLayout& layout = layouts[is_sdl3];
    const uint32_t type = read<uint32_t>(event, 0);
    if (type == key_down || type == key_up) {
        const auto code = read<uint32_t>(event, layout.scancode);
        const auto key = key_of(code);
        return !key || !press(*key, code, type == key_down);
    }
    if (type == button_down || type == button_up) {
        const auto button = read<uint8_t>(event, layout.button);
        const auto key = key_of_button(button);
        return !key || !press(*key, first_button_code + button, type == button_down);
    }
    if (type != wheel || !is_open_)
        return true;
    const float turned = is_sdl3 ? read<float>(event, layout.wheel_y) : float(read<int32_t>(event, layout.wheel_y));
    if (turned != 0) {
        const std::scoped_lock lock(mutex_);
        pressed_.push_back(turned > 0 ? MenuKey::up : MenuKey::down);
    }
    return false;
}

std::vector<MenuKey> KeyFilter::take()
{
    const std::scoped_lock lock(mutex_);
    return std::exchange(pressed_, {});
}

} // namespace vkpt
