// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/material_file.hpp"

#include "common/numbers.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

namespace formats {

namespace {

constexpr size_t longest_name = 64, longest_value = 128;

std::string_view trim(std::string_view text)
{
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_space(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string_view take_line(std::string_view& text)
{
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return trim(line.substr(0, line.find('#')));
}

bool is_printable(std::string_view text)
{
    return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 127; });
}

class Reader {
public:
    Reader(std::string_view text, std::string_view file)
        : text_(text)
        , file_(file)
    {
    }

    MaterialFile read()
    {
        while (!text_.empty()) {
            line_++;
            if (const std::string_view line = take_line(text_); !line.empty())
                read_line(line);
        }
        if (!names_.empty())
            complain("no colon behind the names, so they have no attributes");
        describe_without_effect();
        result_.file = file_;
        return std::move(result_);
    }

private:
    // Names end in a comma or colon, attributes in neither.
    void read_line(std::string_view line)
    {
        if (line.back() == ':' || line.back() == ',' || !names_.empty())
            read_names(line);
        else
            read_attribute(line);
    }

    void read_names(std::string_view line)
    {
        const bool ends = line.back() == ':';
        if (ends)
            line.remove_suffix(1);
        while (!line.empty()) {
            const size_t comma = std::min(line.find(','), line.size());
            read_name(trim(line.substr(0, comma)));
            line.remove_prefix(std::min(comma + 1, line.size()));
        }
        if (!ends)
            return;
        is_open_ = !names_.empty();
        if (!is_open_)
            return complain("a colon without names before it");
        result_.entries.push_back({ std::exchange(names_, {}), {} });
    }

    void read_name(std::string_view name)
    {
        if (name.empty())
            return;
        if (name.size() > longest_name || !is_printable(name))
            return complain("a picture's name that is too long or has spaces in it is left out");
        if (++name_count_ > max_material_names)
            throw FormatError(file_, size_t(line_), "more than " + std::to_string(max_material_names) + " names");
        if (std::string plain = material_name(name); !plain.empty())
            names_.push_back(std::move(plain));
    }

    void read_attribute(std::string_view line)
    {
        const size_t space = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view name = line.substr(0, space), value = trim(line.substr(space));
        const AttributeRow* row = find_attribute(name);
        if (!is_open_)
            return complain("an attribute before the first name is left out");
        if (!row)
            return complain("there is no such attribute: ", name);
        if (!is_attribute_value(*row, value))
            return complain(
                row->type == AttributeType::number ? "its value is a number: " : "its value is one word: ", line);
        result_.entries.back().attributes.emplace_back(name, value);
        if (effect_of(*row, value) == AttributeEffect::none)
            without_effect_[row->name == "kind" ? "kind " + describe_kind(value) : std::string(row->name)]++;
    }

    static std::string describe_kind(std::string_view value)
    {
        constexpr std::string_view of_q2rtx[] = { "SCREEN", "TRANSPARENT" };
        const std::string kind = kind_name(value);
        return std::ranges::find(of_q2rtx, kind) != std::end(of_q2rtx) ? kind : "of other names";
    }

    void describe_without_effect()
    {
        size_t sum = 0;
        std::string list;
        for (const auto& [name, count] : without_effect_) {
            list += (sum > 0 ? ", " : "): ") + name + ' ' + std::to_string(count);
            sum += count;
        }
        if (sum > 0)
            result_.without_effect
                = file_ + ": attributes without effect in this renderer (" + std::to_string(sum) + list;
    }

    void complain(std::string_view reason, std::string_view text = {})
    {
        if (result_.messages.size() >= MaterialFile::max_messages)
            return;
        std::string message = file_;
        message += ", line ";
        message += std::to_string(line_);
        message += ": ";
        message += reason;
        message += text.substr(0, longest_name);
        result_.messages.push_back(std::move(message));
    }

    std::string_view text_;
    std::string file_;
    int line_ = 0;
    size_t name_count_ = 0;
    bool is_open_ = false;
    std::vector<std::string> names_;
    std::map<std::string, size_t> without_effect_; // how often each occurs; a few, whatever the file says
    MaterialFile result_;
};

} // namespace

const std::vector<AttributeRow>& material_attributes()
{
    using enum AttributeType;
    using enum AttributeEffect;
    static const std::vector<AttributeRow> rows {
        { "roughness_override", number, at_once, "roughness, 0 to 1; below 0: not given" },
        { "metalness_override", number, at_once, "metalness, 0 to 1; ours, Q2RTX has none" },
        { "metalness_factor", number, at_once, "times the alpha of the normal map, which is metalness" },
        { "specular_factor", number, at_once, "times what the smooth coat over the colour reflects, 0 to 1" },
        { "base_factor", number, at_once, "times the picture's colour" },
        { "bump_scale", number, at_once, "how far the normal map tilts the surface: 0 not at all, 1 as it says" },
        { "emissive_factor", number, of_walls_with_next_map, "times the light of texture_emissive" },
        { "emissive_threshold", number, with_next_map, "of synth_emissive: texels as bright as this glow, 0 to 255" },
        { "synth_emissive", number, with_next_map, "1: bright texels glow, though no picture says which" },
        { "is_light", number, none, "of Q2RTX; whatever glows on walls is a light" },
        { "light_styles", number, with_next_map, "0: its lamps do not flicker and are not switched" },
        { "bsp_radiance", number, with_next_map, "0: its lamps glow without the map's light value" },
        { "default_radiance", number, with_next_map, "times what glows without the map's light value" },
        { "kind", word, at_once,
            "CHROME: a mirror; GLASS: smooth panes; CAMERA: a screen that shows what the map's cameras see; WATER, "
            "SLIME, LAVA: of liquids; SKY: the sky instead of a wall; INVISIBLE: nothing; these five with the next "
            "map; "
            "others without effect" },
        { "screen_left", number, at_once,
            "of a screen: where in the picture it begins, 0 to 1; ours, as the next three" },
        { "screen_top", number, at_once, "the same from above" },
        { "screen_right", number, at_once, "where it ends, 0 to 1" },
        { "screen_bottom", number, at_once, "the same from above" },
        { "texture_base", word, with_next_map, "file in place of the texture" },
        { "texture_normals", word, with_next_map, "file of its normal map" },
        { "texture_emissive", word, with_next_map, "file of what of it glows" },
        { "texture_mask", word, with_next_map, "of walls: file that is dark where the texture has holes" },
        { "correct_albedo", number, none, "of Q2RTX" },
    };
    return rows;
}

const AttributeRow* find_attribute(std::string_view name)
{
    const auto& rows = material_attributes();
    const auto row = std::ranges::find(rows, name, &AttributeRow::name);
    return row == rows.end() ? nullptr : &*row;
}

std::string kind_name(std::string_view kind)
{
    std::string name(kind);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return name;
}

AttributeEffect effect_of(const AttributeRow& row, std::string_view value)
{
    using enum AttributeEffect;
    if (row.name != "kind")
        return row.effect;
    static const std::map<std::string, AttributeEffect, std::less<>> kinds { { "REGULAR", at_once },
        { "CHROME", at_once }, { "GLASS", at_once }, { "CAMERA", at_once }, { "WATER", with_next_map },
        { "SLIME", with_next_map }, { "LAVA", with_next_map }, { "SKY", with_next_map },
        { "INVISIBLE", with_next_map } };
    const auto found = kinds.find(kind_name(value));
    return found != kinds.end() ? found->second : none;
}

bool is_attribute_value(const AttributeRow& row, std::string_view value)
{
    if (value.empty() || value.size() > longest_value)
        return false;
    if (row.type == AttributeType::word)
        return is_printable(value) && value.find_first_of(",:#") == std::string_view::npos;
    return vkpt::parse_number<float>(value).has_value();
}

std::string material_name(std::string_view picture)
{
    std::string name(picture);
    for (char& c : name)
        c = c == '\\' ? '/' : char(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::string_view folder = "textures/";
    while (name.starts_with(folder))
        name.erase(0, folder.size());
    constexpr std::string_view endings[] = { ".wal", ".tga", ".png", ".jpg", ".pcx", ".m8", ".m32" };
    const auto ending
        = [&] { return std::ranges::find_if(endings, [&](std::string_view e) { return name.ends_with(e); }); };
    for (auto found = ending(); found != std::end(endings); found = ending())
        name.resize(name.size() - found->size());
    return name;
}

MaterialFile read_materials(std::string_view text, std::string_view file)
{
    if (text.size() > max_material_bytes)
        throw FormatError(
            file, max_material_bytes, "materials of more than " + std::to_string(max_material_bytes) + " bytes");
    return Reader(text, file).read();
}

std::string write_materials(const std::vector<MaterialEntry>& entries)
{
    std::string text;
    for (const MaterialEntry& entry : entries) {
        for (size_t i = 0; i < entry.names.size(); i++)
            text += entry.names[i] + (i + 1 < entry.names.size() ? ",\n" : ":\n");
        for (const auto& [name, value] : entry.attributes)
            text += "    " + name + ' ' + value + '\n';
        text += '\n';
    }
    return text;
}

} // namespace formats
