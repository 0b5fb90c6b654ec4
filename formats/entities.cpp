// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/entities.hpp"
#include "common/numbers.hpp"
#include "formats/byte_reader.hpp"

#include <cmath>

namespace formats {

namespace {

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' '; } // the engine's rule

// Reads one finite number and moves past it; the number must end at a blank or at the text's end.
std::optional<float> take_number(std::string_view& text)
{
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    const std::optional<float> value = vkpt::take_number<float>(text);
    return text.empty() || is_space(text.front()) ? value : std::nullopt;
}

struct Token {
    enum Kind { End, Open, Close, Text } kind = End;
    std::string_view text;
    size_t offset = 0;
};

class Tokenizer {
public:
    Tokenizer(std::string_view text, std::string_view file)
        : text_(text)
        , file_(file)
    {
    }

    Token next()
    {
        skip_blanks_and_comments();
        const size_t start = position_;
        if (start == text_.size())
            return { Token::End, {}, start };
        const char c = text_[position_];
        if (c == '{' || c == '}') {
            position_++;
            return { c == '{' ? Token::Open : Token::Close, text_.substr(start, 1), start };
        }
        return c == '"' ? quoted() : word();
    }

    [[noreturn]] void fail(size_t offset, std::string_view reason) const { throw FormatError(file_, offset, reason); }

private:
    Token quoted()
    {
        const size_t start = position_++;
        const size_t end = text_.find('"', position_);
        if (end == std::string_view::npos)
            fail(start, "entities: this quote is never closed");
        position_ = end + 1;
        return { Token::Text, text_.substr(start + 1, end - start - 1), start };
    }

    Token word()
    {
        const size_t start = position_;
        while (position_ < text_.size() && !is_space(text_[position_]) && text_[position_] != '{'
            && text_[position_] != '}' && text_[position_] != '"')
            position_++;
        return { Token::Text, text_.substr(start, position_ - start), start };
    }

    void skip_blanks_and_comments()
    {
        while (position_ < text_.size()) {
            if (is_space(text_[position_])) {
                position_++;
            } else if (text_.substr(position_, 2) == "//") {
                const size_t end = text_.find('\n', position_);
                position_ = end == std::string_view::npos ? text_.size() : end;
            } else {
                return;
            }
        }
    }

    std::string_view text_;
    std::string_view file_;
    size_t position_ = 0;
};

// Skips a brush or patch of a map source; its opening brace is already taken.
void skip_block(Tokenizer& tokens, size_t opening)
{
    for (int depth = 1; depth > 0;) {
        const Token token = tokens.next();
        if (token.kind == Token::End)
            tokens.fail(opening, "entities: this brace is never closed");
        depth += token.kind == Token::Open ? 1 : token.kind == Token::Close ? -1 : 0;
    }
}

EntityText parse_entity(Tokenizer& tokens, size_t opening)
{
    EntityText entity;
    while (true) {
        const Token key = tokens.next();
        if (key.kind == Token::Close)
            return entity;
        if (key.kind == Token::End)
            tokens.fail(opening, "entities: this brace is never closed");
        if (key.kind == Token::Open) {
            skip_block(tokens, key.offset);
            continue;
        }
        const Token value = tokens.next();
        if (value.kind != Token::Text)
            tokens.fail(key.offset, "entities: key \"" + std::string(key.text) + "\" has no value");
        entity.pairs.insert_or_assign(std::string(key.text), std::string(value.text));
    }
}

} // namespace

std::string_view EntityText::get(std::string_view key, std::string_view fallback) const
{
    const auto found = pairs.find(key);
    return found == pairs.end() ? fallback : std::string_view(found->second);
}

float EntityText::number(std::string_view key, float fallback) const
{
    std::string_view text = get(key);
    return take_number(text).value_or(fallback);
}

std::vector<float> EntityText::numbers(std::string_view key) const
{
    std::string_view text = get(key);
    std::vector<float> result;
    while (const std::optional<float> value = take_number(text))
        result.push_back(*value);
    return result;
}

std::optional<glm::vec3> EntityText::vector(std::string_view key) const
{
    std::string_view text = get(key);
    glm::vec3 result;
    for (int axis = 0; axis < 3; axis++) {
        const std::optional<float> value = take_number(text);
        if (!value)
            return std::nullopt;
        result[axis] = *value;
    }
    return result;
}

std::vector<EntityText> parse_entities(std::string_view text, std::string_view file)
{
    Tokenizer tokens(text, file);
    std::vector<EntityText> entities;
    while (true) {
        const Token token = tokens.next();
        if (token.kind == Token::End)
            return entities;
        if (token.kind != Token::Open)
            tokens.fail(
                token.offset, "entities: '{' expected, found \"" + std::string(token.text.substr(0, 40)) + "\"");
        entities.push_back(parse_entity(tokens, token.offset));
    }
}

std::optional<size_t> brush_model_index(std::string_view name)
{
    if (!name.starts_with('*'))
        return std::nullopt;
    name.remove_prefix(1);
    return vkpt::take_number<size_t>(name); // as the engine, which reads no farther
}

} // namespace formats
