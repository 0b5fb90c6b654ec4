// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/map_source.hpp"

#include "common/numbers.hpp"

#include <cmath>
#include <fmt/format.h>

namespace vkpt::tools {

MapError::MapError(std::string_view file, int line, std::string_view reason)
    : std::runtime_error(line > 0 ? fmt::format("{}:{}: {}", file, line, reason) : fmt::format("{}: {}", file, reason))
{
}

std::string_view MapEntity::get(std::string_view key, std::string_view fallback) const
{
    for (const auto& [name, value] : pairs)
        if (name == key)
            return value;
    return fallback;
}

void MapEntity::set(std::string_view key, std::string value)
{
    for (auto& [name, old] : pairs)
        if (name == key) {
            old = std::move(value);
            return;
        }
    pairs.emplace_back(key, std::move(value));
}

namespace {

std::optional<double> to_number(std::string_view text)
{
    if (text.starts_with('+'))
        text.remove_prefix(1);
    return parse_number<double>(text);
}

std::string_view next_word(std::string_view& text)
{
    const size_t start = text.find_first_not_of(" \t");
    if (start == std::string_view::npos)
        return {};
    text.remove_prefix(start);
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    return word;
}

} // namespace

double MapEntity::number(std::string_view key, double fallback) const
{
    std::string_view text = get(key);
    return to_number(next_word(text)).value_or(fallback);
}

std::optional<dvec3> MapEntity::vector(std::string_view key) const
{
    std::string_view text = get(key);
    dvec3 result;
    for (int axis = 0; axis < 3; axis++) {
        const auto value = to_number(next_word(text));
        if (!value)
            return {};
        result[axis] = *value;
    }
    return result;
}

namespace {

struct Token {
    std::string_view text;
    int line = 0;
    bool quoted = false, end = false;
};

// More than any map has; each further one is compared with all before. The engine's own format allows 65,536 sides in
// all.
constexpr size_t max_entity_keys = 512, max_brush_sides = 256;

class Parser {
public:
    Parser(std::string_view text, std::string_view file)
        : text_(text)
        , file_(file)
    {
        advance();
    }

    MapSource parse()
    {
        MapSource map;
        map.file = file_;
        while (!token_.end) {
            if (!is("{"))
                fail(fmt::format(
                    "expected '{{' that begins an entity, found '{}'; look for a '}}' too many above", token_.text));
            map.entities.push_back(parse_entity());
        }
        if (map.entities.empty())
            fail("no entities; a map needs at least a worldspawn with brushes and an info_player_start");
        if (map.entities[0].class_name() != "worldspawn")
            throw MapError(file_, map.entities[0].line, "the first entity must be worldspawn; move it to the top");
        return map;
    }

private:
    [[noreturn]] void fail(std::string_view reason) const { throw MapError(file_, token_.line, reason); }
    bool is(std::string_view text) const { return !token_.end && !token_.quoted && token_.text == text; }

    void skip_blanks()
    {
        while (position_ < text_.size()) {
            const char c = text_[position_];
            if (c == '\n')
                line_++;
            if (c == ' ' || c == '\t' || c == '\r' || c == '\n')
                position_++;
            else if (text_.substr(position_, 2) == "//")
                position_ = std::min(text_.find('\n', position_), text_.size());
            else
                return;
        }
    }

    void advance()
    {
        skip_blanks();
        token_ = { {}, line_, false, position_ >= text_.size() };
        if (token_.end)
            return;
        if (text_[position_] == '"') {
            const size_t close = text_.find_first_of("\"\n", position_ + 1);
            if (close == std::string_view::npos || text_[close] == '\n')
                fail("a quote is opened but not closed on the same line; add the missing '\"'");
            token_.text = text_.substr(position_ + 1, close - position_ - 1);
            token_.quoted = true;
            position_ = close + 1;
            return;
        }
        const size_t end = std::min(text_.find_first_of(" \t\r\n\"", position_), text_.size());
        token_.text = text_.substr(position_, end - position_);
        position_ = end;
    }

    std::string_view take(std::string_view what)
    {
        if (token_.end)
            fail(fmt::format("the file ends where {} should be; a '}}' is missing", what));
        const std::string_view text = token_.text;
        advance();
        return text;
    }

    void expect(std::string_view text, std::string_view where)
    {
        if (!is(text))
            fail(fmt::format("expected '{}' {}, found '{}'", text, where, token_.end ? "end of file" : token_.text));
        advance();
    }

    double number(std::string_view what)
    {
        const auto value = token_.end ? std::nullopt : to_number(token_.text);
        if (!value)
            fail(fmt::format("expected a number ({}), found '{}'", what, token_.end ? "end of file" : token_.text));
        advance();
        return *value;
    }

    // Flags may be written signed or unsigned.
    int64_t integer(std::string_view what)
    {
        const double limit = 4294967295.0;
        if (const auto value = token_.end ? std::nullopt : to_number(token_.text); value && std::abs(*value) > limit)
            fail(fmt::format("{} {} does not fit 32 bits", what, token_.text));
        return int64_t(number(what));
    }

    dvec3 triple(std::string_view what)
    {
        const double x = number(what), y = number(what), z = number(what);
        return { x, y, z };
    }

    MapEntity parse_entity()
    {
        MapEntity entity;
        entity.line = token_.line;
        advance();
        while (!is("}")) {
            if (token_.end)
                throw MapError(file_, entity.line, "this entity is not closed; add the missing '}'");
            if (is("{"))
                entity.brushes.push_back(parse_brush());
            else if (token_.quoted)
                parse_pair(entity);
            else
                fail(fmt::format("expected a quoted key, a brush '{{' or '}}', found '{}'", token_.text));
        }
        advance();
        return entity;
    }

    void parse_pair(MapEntity& entity)
    {
        const std::string key(take("a key"));
        if (!token_.quoted)
            fail(fmt::format("key \"{}\" has no quoted value", key));
        entity.set(key, std::string(take("a value")));
        if (entity.pairs.size() > max_entity_keys)
            fail(fmt::format("this entity has more than {} keys", max_entity_keys));
    }

    MapBrushSource parse_brush()
    {
        MapBrushSource brush;
        brush.line = token_.line;
        advance();
        if (is("brushDef") || is("brushDef3") || is("patchDef2"))
            fail("brush primitives and patches are not Quake II's; save the map in the Quake II format (standard or "
                 "Valve)");
        while (!is("}")) {
            if (token_.end)
                throw MapError(file_, brush.line, "this brush is not closed; add the missing '}'");
            brush.sides.push_back(parse_side());
            if (brush.sides.size() > max_brush_sides)
                fail(fmt::format("this brush has more than {} sides; make it of several brushes", max_brush_sides));
        }
        advance();
        if (brush.sides.size() < 4)
            throw MapError(
                file_, brush.line, fmt::format("a brush needs at least 4 sides, this has {}", brush.sides.size()));
        return brush;
    }

    MapSide parse_side()
    {
        MapSide side;
        side.line = token_.line;
        for (dvec3& point : side.points) {
            expect("(", "before a point of a brush side");
            point = triple("a point's coordinate");
            expect(")", "after a point of a brush side");
        }
        side.texture = take("a texture name");
        side.valve_axes = is("[");
        for (int i = 0; i < 2; i++) {
            if (side.valve_axes) {
                expect("[", "before a texture axis");
                side.axes[size_t(i)] = triple("a texture axis");
            }
            side.shift[size_t(i)] = number("texture shift");
            if (side.valve_axes)
                expect("]", "after a texture axis");
        }
        side.rotation = number("texture rotation");
        for (double& scale : side.scale)
            scale = number("texture scale");
        parse_surface(side);
        return side;
    }

    // The three numbers at the line's end; editors leave them out where nothing differs from the texture.
    void parse_surface(MapSide& side)
    {
        if (token_.end || token_.line != side.line || is("}"))
            return;
        MapSide::Surface surface;
        surface.contents = uint32_t(integer("contents"));
        surface.flags = uint32_t(integer("surface flags"));
        surface.value = int(int32_t(integer("surface value")));
        side.surface = surface;
    }

    std::string_view text_;
    std::string file_;
    size_t position_ = 0;
    int line_ = 1;
    Token token_;
};

} // namespace

MapSource parse_map(std::string_view text, std::string_view file) { return Parser(text, file).parse(); }

} // namespace vkpt::tools
