// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/pixel_font.hpp"

#include "tools/asset_generator/palette.hpp"

#include <array>
#include <string_view>

namespace vkpt::tools {

namespace {
struct Glyph {
    char letter;
    std::string_view rows; // eight rows of six pixels, the last one for descenders
};
constexpr std::array glyphs {
    Glyph { '!', "..##.. ..##.. ..##.. ..##.. ...... ..##.. ..##.. ......" },
    Glyph { '"', "##..## ##..## .#..#. ...... ...... ...... ...... ......" },
    Glyph { '#', ".#..#. .#..#. ###### .#..#. ###### .#..#. .#..#. ......" },
    Glyph { '$', "..##.. .##### ##.#.. .####. ..#.## #####. ..##.. ......" },
    Glyph { '%', "##...# ##..#. ...#.. ..#... .#.... #..### ...### ......" },
    Glyph { '&', ".###.. ##.... .##... .###.# ##..#. ##..#. .###.# ......" },
    Glyph { '\'', "..##.. ..##.. ..#... ...... ...... ...... ...... ......" },
    Glyph { '(', "...##. ..##.. .##... .##... .##... ..##.. ...##. ......" },
    Glyph { ')', ".##... ..##.. ...##. ...##. ...##. ..##.. .##... ......" },
    Glyph { '*', "...... .#..#. ..##.. ###### ..##.. .#..#. ...... ......" },
    Glyph { '+', "...... ..##.. ..##.. ###### ..##.. ..##.. ...... ......" },
    Glyph { ',', "...... ...... ...... ...... ...... ..##.. ..##.. ..#..." },
    Glyph { '-', "...... ...... ...... ###### ...... ...... ...... ......" },
    Glyph { '.', "...... ...... ...... ...... ...... ..##.. ..##.. ......" },
    Glyph { '/', "....## ....## ...##. ..##.. .##... ##.... ##.... ......" },
    Glyph { '0', ".####. ##..## ##.### ###.## ##..## ##..## .####. ......" },
    Glyph { '1', "..##.. .###.. ..##.. ..##.. ..##.. ..##.. ###### ......" },
    Glyph { '2', "#####. ....## ....## .####. ##.... ##.... ###### ......" },
    Glyph { '3', "#####. ....## ....## ..###. ....## ....## #####. ......" },
    Glyph { '4', "##..## ##..## ##..## ###### ....## ....## ....## ......" },
    Glyph { '5', "###### ##.... ##.... #####. ....## ....## #####. ......" },
    Glyph { '6', ".####. ##.... ##.... #####. ##..## ##..## .####. ......" },
    Glyph { '7', "###### ....## ....## ...##. ..##.. ..##.. ..##.. ......" },
    Glyph { '8', ".####. ##..## ##..## .####. ##..## ##..## .####. ......" },
    Glyph { '9', ".####. ##..## ##..## .##### ....## ....## .####. ......" },
    Glyph { ':', "...... ..##.. ..##.. ...... ..##.. ..##.. ...... ......" },
    Glyph { ';', "...... ..##.. ..##.. ...... ..##.. ..##.. ..#... ......" },
    Glyph { '<', "....## ...##. ..##.. .##... ..##.. ...##. ....## ......" },
    Glyph { '=', "...... ...... ###### ...... ###### ...... ...... ......" },
    Glyph { '>', "##.... .##... ..##.. ...##. ..##.. .##... ##.... ......" },
    Glyph { '?', "#####. ....## ....## ..###. ...... ..##.. ..##.. ......" },
    Glyph { '@', ".####. ##...# ##.### ##.#.# ##.### ##.... .##### ......" },
    Glyph { 'A', ".####. ##..## ##..## ###### ##..## ##..## ##..## ......" },
    Glyph { 'B', "#####. ##..## ##..## #####. ##..## ##..## #####. ......" },
    Glyph { 'C', ".##### ##.... ##.... ##.... ##.... ##.... .##### ......" },
    Glyph { 'D', "####.. ##.##. ##..## ##..## ##..## ##.##. ####.. ......" },
    Glyph { 'E', "###### ##.... ##.... ####.. ##.... ##.... ###### ......" },
    Glyph { 'F', "###### ##.... ##.... ####.. ##.... ##.... ##.... ......" },
    Glyph { 'G', ".##### ##.... ##.... ##.### ##..## ##..## .##### ......" },
    Glyph { 'H', "##..## ##..## ##..## ###### ##..## ##..## ##..## ......" },
    Glyph { 'I', ".####. ..##.. ..##.. ..##.. ..##.. ..##.. .####. ......" },
    Glyph { 'J', "..#### ....## ....## ....## ....## ##..## .####. ......" },
    Glyph { 'K', "##..## ##.##. ####.. ###... ####.. ##.##. ##..## ......" },
    Glyph { 'L', "##.... ##.... ##.... ##.... ##.... ##.... ###### ......" },
    Glyph { 'M', "##...# ###.## ###### ##.#.# ##...# ##...# ##...# ......" },
    Glyph { 'N', "##..## ###.## ###.## ###### ##.### ##.### ##..## ......" },
    Glyph { 'O', ".####. ##..## ##..## ##..## ##..## ##..## .####. ......" },
    Glyph { 'P', "#####. ##..## ##..## #####. ##.... ##.... ##.... ......" },
    Glyph { 'Q', ".####. ##..## ##..## ##..## ##..## ##.##. .##.## ......" },
    Glyph { 'R', "#####. ##..## ##..## #####. ####.. ##.##. ##..## ......" },
    Glyph { 'S', ".##### ##.... ##.... .####. ....## ....## #####. ......" },
    Glyph { 'T', "###### ..##.. ..##.. ..##.. ..##.. ..##.. ..##.. ......" },
    Glyph { 'U', "##..## ##..## ##..## ##..## ##..## ##..## .####. ......" },
    Glyph { 'V', "##..## ##..## ##..## ##..## ##..## .####. ..##.. ......" },
    Glyph { 'W', "##...# ##...# ##...# ##.#.# ###### ###.## ##...# ......" },
    Glyph { 'X', "##..## ##..## .####. ..##.. .####. ##..## ##..## ......" },
    Glyph { 'Y', "##..## ##..## ##..## .####. ..##.. ..##.. ..##.. ......" },
    Glyph { 'Z', "###### ....## ...##. ..##.. .##... ##.... ###### ......" },
    Glyph { '[', ".####. .##... .##... .##... .##... .##... .####. ......" },
    Glyph { '\\', "##.... ##.... .##... ..##.. ...##. ....## ....## ......" },
    Glyph { ']', ".####. ...##. ...##. ...##. ...##. ...##. .####. ......" },
    Glyph { '^', "..##.. .####. ##..## ...... ...... ...... ...... ......" },
    Glyph { '_', "...... ...... ...... ...... ...... ...... ###### ......" },
    Glyph { '`', ".##... ..##.. ...#.. ...... ...... ...... ...... ......" },
    Glyph { 'a', "...... ...... .####. ....## .##### ##..## .##### ......" },
    Glyph { 'b', "##.... ##.... #####. ##..## ##..## ##..## #####. ......" },
    Glyph { 'c', "...... ...... .##### ##.... ##.... ##.... .##### ......" },
    Glyph { 'd', "....## ....## .##### ##..## ##..## ##..## .##### ......" },
    Glyph { 'e', "...... ...... .####. ##..## ###### ##.... .##### ......" },
    Glyph { 'f', "..#### .##... #####. .##... .##... .##... .##... ......" },
    Glyph { 'g', "...... ...... .##### ##..## ##..## .##### ....## .####." },
    Glyph { 'h', "##.... ##.... #####. ##..## ##..## ##..## ##..## ......" },
    Glyph { 'i', "..##.. ...... .###.. ..##.. ..##.. ..##.. .####. ......" },
    Glyph { 'j', "...##. ...... ..###. ...##. ...##. ...##. ...##. .###.." },
    Glyph { 'k', "##.... ##.... ##..## ##.##. ####.. ##.##. ##..## ......" },
    Glyph { 'l', ".###.. ..##.. ..##.. ..##.. ..##.. ..##.. ..#### ......" },
    Glyph { 'm', "...... ...... ##.##. ###### ##.#.# ##.#.# ##...# ......" },
    Glyph { 'n', "...... ...... #####. ##..## ##..## ##..## ##..## ......" },
    Glyph { 'o', "...... ...... .####. ##..## ##..## ##..## .####. ......" },
    Glyph { 'p', "...... ...... #####. ##..## ##..## #####. ##.... ##...." },
    Glyph { 'q', "...... ...... .##### ##..## ##..## .##### ....## ....##" },
    Glyph { 'r', "...... ...... ##.### ####.. ##.... ##.... ##.... ......" },
    Glyph { 's', "...... ...... .##### ##.... .####. ....## #####. ......" },
    Glyph { 't', ".##... .##... #####. .##... .##... .##... ..#### ......" },
    Glyph { 'u', "...... ...... ##..## ##..## ##..## ##..## .##### ......" },
    Glyph { 'v', "...... ...... ##..## ##..## ##..## .####. ..##.. ......" },
    Glyph { 'w', "...... ...... ##...# ##.#.# ##.#.# ###### .##.#. ......" },
    Glyph { 'x', "...... ...... ##..## .####. ..##.. .####. ##..## ......" },
    Glyph { 'y', "...... ...... ##..## ##..## ##..## .##### ....## .####." },
    Glyph { 'z', "...... ...... ###### ...##. ..##.. .##... ###### ......" },
    Glyph { '{', "...##. ..##.. ..##.. .##... ..##.. ..##.. ...##. ......" },
    Glyph { '|', "..##.. ..##.. ..##.. ..##.. ..##.. ..##.. ..##.. ......" },
    Glyph { '}', ".##... ..##.. ..##.. ...##. ..##.. ..##.. .##... ......" },
    Glyph { '~', "...... .##..# ###.## #..##. ...... ...... ...... ......" },
};

// Pieces that the engine draws by number; letters name the inks in `ink_of`.
struct Piece {
    int code;
    std::string_view rows; // eight rows of eight pixels
};
constexpr std::array pieces {
    // 1-9: the menus' text box, corners and edges around a filled middle.
    Piece { 1, "........ ..ffffff .fhhhhhh fhffffff fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb" },
    Piece { 2, "........ ffffffff hhhhhhhh ffffffff bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb" },
    Piece { 3, "........ ffffff.. hhhhhhf. ffffffhf bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf" },
    Piece { 4, "fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb" },
    Piece { 5, "bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb" },
    Piece { 6, "bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf" },
    Piece { 7, "fhfbbbbb fhfbbbbb fhfbbbbb fhfbbbbb fhffffff .fhhhhhh ..ffffff ........" },
    Piece { 8, "bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb ffffffff hhhhhhhh ffffffff ........" },
    Piece { 9, "bbbbbfhf bbbbbfhf bbbbbfhf bbbbbfhf ffffffhf hhhhhhf. ffffff.. ........" },
    // 10 and 11: the console's cursor, off and on. 12 and 13: the menus' pointer, blinking.
    Piece { 11, "........ iiiiii.. iiiiii.. iiiiii.. iiiiii.. iiiiii.. iiiiii.. ........" },
    Piece { 12, ".ff..... .fff.... .ffff... .fffff.. .ffff... .fff.... .ff..... ........" },
    Piece { 13, ".ii..... .iii.... .iiii... .iiiii.. .iiii... .iii.... .ii..... ........" },
    // 14 and 15: marks in lists (a dot, and the inventory's flashing arrow).
    Piece { 14, "........ ........ ..ff.... .fhhf... .fhhf... ..ff.... ........ ........" },
    Piece { 15, ".i...... .iii.... .iiiii.. .iiiiii. .iiiii.. .iii.... .i...... ........" },
    Piece { 16, ".iiii... .ii..... .ii..... .ii..... .ii..... .ii..... .iiii... ........" },
    Piece { 17, "...iiii. .....ii. .....ii. .....ii. .....ii. .....ii. ...iiii. ........" },
    // 18-26: the frame of input fields, upper row and lower row (half a cell apart).
    Piece { 18, "........ ........ ..ffffff .fhhhhhh .fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb" },
    Piece { 19, "........ ........ ffffffff hhhhhhhh bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb" },
    Piece { 20, "........ ........ ffffff.. hhhhhhf. bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf." },
    Piece { 21, ".fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb" },
    Piece { 22, "bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb" },
    Piece { 23, "bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf." },
    Piece { 24, ".fhbbbbb .fhbbbbb .fhbbbbb .fhbbbbb .fhhhhhh ..ffffff ........ ........" },
    Piece { 25, "bbbbbbbb bbbbbbbb bbbbbbbb bbbbbbbb hhhhhhhh ffffffff ........ ........" },
    Piece { 26, "bbbbbhf. bbbbbhf. bbbbbhf. bbbbbhf. hhhhhhf. ffffff.. ........ ........" },
    Piece { 28, "........ ........ ...hh... ..hhhh.. ..hhhh.. ...hh... ........ ........" },
    // 29-31: a ruler's left end, middle and right end, between console messages.
    Piece { 29, "........ ........ ........ ..hfffff ..hfffff ........ ........ ........" },
    Piece { 30, "........ ........ ........ ffffffff ffffffff ........ ........ ........" },
    Piece { 31, "........ ........ ........ fffffh.. fffffh.. ........ ........ ........" },
    Piece { 127, "........ .fffff.. .f...f.. .f...f.. .f...f.. .fffff.. ........ ........" },
    // 128-131: sliders and progress bars: left end, track, right end, knob.
    Piece { 128, "........ ....ffff ...fbbbb ...fbhhh ...fbhhh ...fbbbb ....ffff ........" },
    Piece { 129, "........ ffffffff bbbbbbbb hhhhhhhh hhhhhhhh bbbbbbbb ffffffff ........" },
    Piece { 130, "........ ffff.... bbbbf... hhhbf... hhhbf... bbbbf... ffff.... ........" },
    Piece { 131, "..iiii.. .iwwwwi. .iwiiwi. .iwiiwi. .iwiiwi. .iwiiwi. .iwwwwi. ..iiii.." },
    // 139-141: the pieces 11-13 in the second half.
    Piece { 139, "........ iiiiii.. iiiiii.. iiiiii.. iiiiii.. iiiiii.. iiiiii.. ........" },
    Piece { 140, ".ff..... .fff.... .ffff... .fffff.. .ffff... .fff.... .ff..... ........" },
    Piece { 141, ".ii..... .iii.... .iiii... .iiiii.. .iiii... .iii.... .ii..... ........" },
    Piece { 157, "........ ........ ........ ..iiiiii ..iiiiii ........ ........ ........" },
    Piece { 158, "........ ........ ........ iiiiiiii iiiiiiii ........ ........ ........" },
    Piece { 159, "........ ........ ........ iiiiii.. iiiiii.. ........ ........ ........" },
};

uint8_t ink_of(char letter)
{
    switch (letter) {
    case 'f':
        return nearest_index({ 0.22f, 0.56f, 0.62f }); // frame
    case 'h':
        return nearest_index({ 0.08f, 0.27f, 0.33f }); // inner line
    case 'b':
        return nearest_index({ 0.04f, 0.06f, 0.08f }); // body
    case 'i':
        return nearest_index({ 1.0f, 0.72f, 0.22f }); // amber highlight
    case 'w':
        return nearest_index({ 1.0f, 0.94f, 0.72f });
    default:
        return transparent_index;
    }
}

class Sheet {
public:
    Sheet()
        : image_ { 128, 128, std::vector<uint8_t>(size_t(128) * 128, transparent_index), game_palette() }
    {
    }
    void set(int code, int x, int y, uint8_t index)
    {
        if (x < 8 && y < 8)
            pixel(code, x, y) = index;
    }
    void draw_letter(int code, std::string_view rows, glm::vec3 top, glm::vec3 bottom)
    {
        const uint8_t shadow = nearest_index(glm::vec3(0.02f));
        const auto lit = [&](int x, int y) { return rows[size_t(y * 7 + x)] == '#'; };
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 6; x++)
                if (lit(x, y))
                    set(code, x + 1, y + 1, shadow);
        for (int y = 0; y < 8; y++) {
            const glm::vec3 colour = top + (bottom - top) * (float(y) / 7.0f);
            for (int x = 0; x < 6; x++)
                if (lit(x, y))
                    set(code, x, y, nearest_index(colour));
        }
    }
    void draw_piece(const Piece& piece)
    {
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 8; x++)
                set(piece.code, x, y, ink_of(piece.rows[size_t(y * 9 + x)]));
    }
    formats::IndexedImage take() { return std::move(image_); }

private:
    uint8_t& pixel(int code, int x, int y)
    {
        return image_.pixels[size_t((code / 16 * 8 + y) * 128 + code % 16 * 8 + x)];
    }
    formats::IndexedImage image_;
};
}

formats::IndexedImage make_character_sheet()
{
    Sheet sheet;
    for (const Glyph& glyph : glyphs) {
        sheet.draw_letter(glyph.letter, glyph.rows, glm::vec3(0.95f), { 0.66f, 0.72f, 0.78f });
        sheet.draw_letter(glyph.letter + 128, glyph.rows, { 1.0f, 0.86f, 0.46f }, { 0.94f, 0.56f, 0.14f });
    }
    for (const Piece& piece : pieces)
        sheet.draw_piece(piece);
    return sheet.take();
}

} // namespace vkpt::tools
