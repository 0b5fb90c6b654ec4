// SPDX-License-Identifier: GPL-2.0-or-later
// Text files that say what surfaces are made of (.mat), in the format of Q2RTX:
//
//     # a comment
//     e1u1/metal5_4,
//     textures/e1u1/metal5_5:
//         roughness_override 0.3
//         metalness_override 1
//
// One or more names of pictures, with commas between them and a colon behind the last, then lines of attribute and
// value.
#pragma once

#include "formats/byte_reader.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace formats {

struct MaterialEntry {
    std::vector<std::string> names; // as material_name() makes them
    std::vector<std::pair<std::string, std::string>> attributes; // known ones, in order; values fit their type
};

struct MaterialFile {
    std::string file; // its name
    std::vector<MaterialEntry> entries;
    std::vector<std::string> messages; // lines that were left out, by file and line; at most so many
    std::string without_effect; // a line that counts those that were read and change nothing; empty: there are none
    static constexpr size_t max_messages = 16;
};

// Bytes of a file, and names in it.
inline constexpr size_t max_material_bytes = 4 << 20;
inline constexpr size_t max_material_names = 100'000;

// Never fails on what is in the lines: what makes no sense is left out, with a message. Throws FormatError for files
// beyond the limits above.
MaterialFile read_materials(std::string_view text, std::string_view file);

// What read_materials reads again.
std::string write_materials(const std::vector<MaterialEntry>& entries);

// Names of one picture are one: "textures/e1u1/Floor.wal" is "e1u1/floor". Of models' skins: "models/x/skin".
std::string material_name(std::string_view picture);

enum class AttributeType { number, word };
// When a change of an attribute is seen: of a map that is there, or with the next one only. `none`: Q2RTX has it, and
// it changes nothing here.
enum class AttributeEffect { at_once, of_walls_with_next_map, with_next_map, none };
// Nothing: there is no such attribute.
struct AttributeRow {
    std::string_view name;
    AttributeType type;
    AttributeEffect effect;
    std::string_view purpose;
};
const std::vector<AttributeRow>& material_attributes();
const AttributeRow* find_attribute(std::string_view name);
// With this value: kinds differ.
AttributeEffect effect_of(const AttributeRow& row, std::string_view value);
// In capitals, as kinds are compared.
std::string kind_name(std::string_view kind);
// Whether the text is a value of that type: a finite number, or one word of printable characters.
bool is_attribute_value(const AttributeRow& row, std::string_view value);

} // namespace formats
