// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/walk_text.hpp"

#include <fmt/format.h>

namespace vkpt::game {

namespace {

constexpr float farthest = 32768, fastest = 400, longest = 3600;

// The words of a line, one after another.
class Line {
public:
    explicit Line(std::span<const std::string> words)
        : words_(words)
    {
    }
    bool empty() const { return words_.empty(); }
    bool has_number() const { return !empty() && words_.front().find_first_of("0123456789") == 0; }
    std::string word(std::string_view what)
    {
        if (empty())
            throw TextError(fmt::format("{} is missing at the end", what));
        const std::string first = words_.front();
        words_ = words_.subspan(1);
        return first;
    }
    float number(std::string_view what, float least, float most) { return parse_number(word(what), what, least, most); }
    glm::vec3 place()
    {
        glm::vec3 p;
        for (int i = 0; i < 3; i++)
            p[i] = number("the place (x y z)", -farthest, farthest);
        return p;
    }
    glm::vec3 angles()
    {
        const float pitch = number("the pitch", -90, 90);
        return { pitch, number("the yaw", -360, 360), 0 };
    }

private:
    std::span<const std::string> words_;
};

TimedInput parse_input(Line& line)
{
    TimedInput input;
    input.seconds = line.number("the seconds", 0.1f, longest);
    while (!line.empty()) {
        const std::string word = line.word("");
        if (word == "forward")
            input.forward = line.number("forward", -fastest, fastest);
        else if (word == "side")
            input.side = line.number("side", -fastest, fastest);
        else if (word == "up")
            input.up = line.number("up", -fastest, fastest);
        else if (word == "pitch") {
            input.angles.x = line.number("pitch", -90, 90);
            input.turns_pitch = true;
        } else if (word == "yaw") {
            input.angles.y = line.number("yaw", -360, 360);
            input.turns_yaw = true;
        } else if (word == "attack")
            input.attack = true;
        else
            throw TextError(fmt::format("'{}' is none of forward, side, up, pitch, yaw, attack", word));
    }
    return input;
}

Step parse_step(Line& line)
{
    Step step;
    step.place = line.place();
    step.angles = line.angles();
    while (!line.empty()) {
        const std::string word = line.word("");
        if (word == "jump") {
            step.jump = true;
            if (line.has_number())
                step.jump_share = line.number("the share", 0, 1);
        } else if (word == "duck")
            step.duck = true;
        else if (word == "attack")
            step.attack = true;
        else
            throw TextError(fmt::format("'{}' is none of jump, duck, attack", word));
    }
    return step;
}

WalkAction parse_action(std::span<const std::string> words)
{
    Line line(words);
    const std::string verb = line.word("");
    WalkAction action;
    if (verb == "goto")
        action = GoTo { line.place() };
    else if (verb == "wait")
        action = Wait { line.number("the seconds", 0, longest) };
    else if (verb == "look")
        action = Look { line.angles() };
    else if (verb == "input")
        action = parse_input(line);
    else if (verb == "step")
        action = parse_step(line);
    else
        throw TextError(fmt::format("'{}' is none of goto, wait, look, input, step", verb));
    if (!line.empty())
        throw TextError(fmt::format("'{}' is one word too many", line.word("")));
    return action;
}

std::string write(const GoTo& a) { return fmt::format("goto {} {} {}", a.place.x, a.place.y, a.place.z); }
std::string write(const Wait& a) { return fmt::format("wait {}", a.seconds); }
std::string write(const Look& a) { return fmt::format("look {} {}", a.angles.x, a.angles.y); }
std::string write(const TimedInput& a)
{
    std::string text = fmt::format("input {}", a.seconds);
    for (const auto& [name, value] : { std::pair("forward", a.forward), { "side", a.side }, { "up", a.up } })
        if (value != 0)
            text += fmt::format(" {} {}", name, value);
    if (a.turns_pitch)
        text += fmt::format(" pitch {}", a.angles.x);
    if (a.turns_yaw)
        text += fmt::format(" yaw {}", a.angles.y);
    return text + (a.attack ? " attack" : "");
}
std::string write(const Step& a)
{
    return fmt::format("step {} {} {} {:.2f} {:.2f}{}{}{}", a.place.x, a.place.y, a.place.z, a.angles.x, a.angles.y,
        a.jump ? fmt::format(" jump {:.2f}", a.jump_share) : "", a.duck ? " duck" : "", a.attack ? " attack" : "");
}

} // namespace

std::vector<WalkAction> parse_walk_file(std::string_view text, std::string_view name)
{
    std::vector<WalkAction> actions;
    read_lines(text, name, [&](const std::vector<std::string>& words) {
        actions.push_back(parse_action(words));
        if (actions.size() > max_walk_actions)
            throw TextError(fmt::format("more than {} lines", max_walk_actions));
    });
    return actions;
}

std::string write_walk_file(std::span<const WalkAction> actions, std::string_view map)
{
    std::string text = fmt::format("{} in {} (docs/game.md)\n", walk_file_mark, map);
    for (const WalkAction& action : actions)
        text += std::visit([](const auto& a) { return write(a); }, action) + "\n";
    return text;
}

} // namespace vkpt::game
