// SPDX-License-Identifier: GPL-2.0-or-later
// What the display shows of a window, as a PNG:   grab_window WIDTH HEIGHT FILE
// The window is the first one of that size. Exit status 1: there is none.
#include "formats/image.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace {

// None: no such window below this one.
Window find_window(Display* display, Window parent, int width, int height)
{
    Window root, above, *children = nullptr;
    unsigned count = 0;
    if (!XQueryTree(display, parent, &root, &above, &children, &count))
        return None;
    Window found = None;
    for (unsigned i = 0; i < count && found == None; i++) {
        XWindowAttributes about;
        if (XGetWindowAttributes(display, children[i], &about) && about.map_state == IsViewable && about.width == width
            && about.height == height)
            found = children[i];
        else
            found = find_window(display, children[i], width, height);
    }
    XFree(children);
    return found;
}

} // namespace

int main(int count, char** arguments)
{
    Display* display = XOpenDisplay(nullptr);
    if (count != 4 || !display)
        return 1;
    const int width = std::atoi(arguments[1]), height = std::atoi(arguments[2]);
    const Window window = find_window(display, DefaultRootWindow(display), width, height);
    XImage* image = window == None
        ? nullptr
        : XGetImage(display, window, 0, 0, unsigned(width), unsigned(height), AllPlanes, ZPixmap);
    if (!image || image->red_mask != 0xff0000 || image->blue_mask != 0xff)
        return 1;
    formats::Image picture { width, height, {} };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const unsigned long pixel = XGetPixel(image, x, y);
            picture.pixels.push_back({ uint8_t(pixel >> 16), uint8_t(pixel >> 8), uint8_t(pixel), 255 });
        }
    const std::vector<std::byte> png = formats::write_png(picture);
    std::ofstream file(arguments[3], std::ios::binary);
    file.write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
    file.close();
    return file ? 0 : 1;
}
