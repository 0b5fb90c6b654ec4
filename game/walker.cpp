// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/walker.hpp"

#include "ref_vkpt/files/output_folder.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

namespace vkpt::game {

namespace {

constexpr int parts = 4; // inputs in a server frame
constexpr int part_milliseconds = 25, frame_milliseconds = parts * part_milliseconds;
constexpr float part_seconds = 0.001f * part_milliseconds;
constexpr float run_speed = 400; // of inputs; the engine walks at 300
constexpr float jump_input = 400;
constexpr float farthest_step = 160; // units in a frame; more is a teleporter
constexpr int patience = 80 * parts; // inputs that steps may wait for a door or a lift
constexpr float farthest_lag = 8; // units behind a step's place at which it waits
constexpr float approach_seconds = 0.1f; // in which a lag is made good
constexpr float inertia = 3; // the share of a wrong velocity that an input goes against
constexpr int settle_frames = 4; // of a new level before a player may act

constexpr std::string_view walk_usage
    = "walk FILE, walk record FILE, walk explore SECONDS [SEED] (0 seconds: until walk "
      "stop), walk stop|status|die";

int16_t to_short_angle(float degrees) { return int16_t(uint16_t(int(std::lround(degrees * 65536 / 360)) & 65535)); }
int frames_of(float seconds) { return std::max(1, int(std::lround(seconds / frame_seconds))); }
int parts_of(float seconds) { return frames_of(seconds) * parts; }
float level_length(glm::vec3 v) { return std::hypot(v.x, v.y); }

// How far a player is behind a place that moves, along the ground.
float find_distance_behind(glm::vec3 lag, glm::vec3 velocity)
{
    const float speed = level_length(velocity);
    return speed > 1 ? (lag.x * velocity.x + lag.y * velocity.y) / speed : level_length(lag);
}

} // namespace

TextFiles Walker::files() const
{
    if (host_.write_folder.empty())
        throw FileError("the engine's writable folder was not found");
    return TextFiles(host_.write_folder, "walks", std::string(walk_file_mark));
}

void Walker::run(const Command& command, const std::vector<bool>& is_client)
{
    const std::string verb = command.word(0);
    if (verb.empty())
        throw TextError(std::string(walk_usage));
    if (verb == "stop")
        return stop(command.sender);
    if (verb == "status") {
        host_.say(command.sender,
            mode_ == Mode::explore ? describe_tour()
                : is_walking()     ? "walk: " + name_
                                   : "walk: none");
        return;
    }
    if (verb == "die") {
        if (!player() || !player()->client)
            throw TextError("nobody walks");
        return fake_client_.type(player(), "kill");
    }
    if (verb == "explore")
        return explore(command, is_client);
    if (verb == "record") {
        name_ = command.word(1);
        if (!is_plain_name(name_))
            throw TextError("walk record NAME: letters, digits, _ and - only");
        actions_.clear();
        start(Mode::record, command, is_client);
        host_.say(command.sender, "recording; walk stop writes " + files().describe(name_));
        return;
    }
    actions_ = parse_walk_file(files().read(verb), files().describe(verb));
    name_ = verb;
    action_ = 0;
    action_parts_ = 0;
    step_from_.reset();
    explorer_ = std::make_unique<Explorer>(0);
    start(Mode::file, command, is_client);
}

void Walker::explore(const Command& command, const std::vector<bool>& is_client)
{
    constexpr float longest = 1e6f;
    const float seconds = command.word(1).empty() ? 0 : parse_number(command.word(1), "the seconds", 0, longest);
    const float seed = command.word(2).empty() ? 0 : parse_number(command.word(2), "the seed", 0, longest);
    explorer_ = std::make_unique<Explorer>(uint32_t(seed));
    frames_left_ = seconds > 0 ? frames_of(seconds) : -1;
    start(Mode::explore, command, is_client);
}

void Walker::start(Mode mode, const Command& command, const std::vector<bool>& is_client)
{
    mode_ = Mode::none;
    if (command.player) {
        player_ = host_.number_of(command.player);
    } else {
        if (!fake_client_.edict() && !fake_client_.connect(is_client))
            throw TextError("there is no place for a player, or the game refuses one");
        player_ = host_.number_of(fake_client_.edict());
    }
    const PlayerView view = view_of(*player());
    angles_ = to_vec3(player()->client->state.view_angles);
    start_angles_ = angles_;
    last_origin_ = view.origin;
    was_alive_ = true;
    pressed_ = {};
    step_milliseconds_ = 0;
    mode_ = mode;
    level_frame_ = host_.frame;
    if (explorer_) {
        explorer_->set_lifts(find_lifts(host_, brushes_));
        explorer_->reset_view(angles_);
        if (mode == Mode::file)
            explorer_->clear_goal();
    }
}

std::string Walker::describe_tour() const
{
    return fmt::format("walk: {} places seen of {} known in {}, {} s", explorer_->seen_count(),
        explorer_->navigation().nodes().size(), host_.map, (host_.frame - level_frame_) / 10);
}

void Walker::stop(Edict* asker)
{
    const Mode mode = mode_;
    mode_ = Mode::none;
    if (mode == Mode::record)
        save_record(asker);
    else if (mode == Mode::explore)
        host_.say(asker, describe_tour() + ": ended");
    else if (mode == Mode::file)
        host_.say(asker, "walk: " + name_ + ": ended");
}

void Walker::save_record(Edict* asker)
{
    files().write(name_, write_walk_file(actions_, host_.map));
    host_.say(asker, fmt::format("{} steps written to {}", actions_.size(), files().describe(name_)));
}

void Walker::begin_level(std::string_view entity_text)
{
    brushes_ = read_brush_entities(entity_text);
    must_begin_ = fake_client_.edict() != nullptr;
    level_frame_ = 0;
    is_view_shown_ = false;
    if (explorer_) // a new map to learn
        explorer_ = std::make_unique<Explorer>(0);
    if (mode_ == Mode::record || mode_ == Mode::file)
        mode_ = Mode::none;
}

PlayerView Walker::view_of(const Edict& edict) const
{
    PlayerView view;
    view.origin = to_vec3(edict.state.origin);
    for (int i = 0; i < 3; i++)
        view.velocity[i] = float(edict.client->state.move.velocity[i]) / 8;
    view.on_ground = (edict.client->state.move.flags & PMF_ON_GROUND) != 0;
    view.in_water = (host_.contents(view.origin) & mask_liquid) != 0;
    return view;
}

Explorer::Arrival Walker::note_arrival(const PlayerView& view, bool is_alive)
{
    Explorer::Arrival arrival = Explorer::Arrival::none;
    if (is_alive && !was_alive_)
        arrival = Explorer::Arrival::reborn;
    else if (glm::distance(view.origin, last_origin_) > farthest_step)
        arrival = Explorer::Arrival::teleported;
    was_alive_ = is_alive;
    last_origin_ = view.origin;
    return arrival;
}

void Walker::drive()
{
    if (must_begin_ && host_.frame > settle_frames) {
        must_begin_ = false;
        fake_client_.begin();
        if (explorer_)
            explorer_->set_lifts(find_lifts(host_, brushes_));
    }
    Edict* edict = player();
    if (!is_walking() || must_begin_ || !edict || !edict->client || !is_true(edict->in_use))
        return;
    const PlayerState& state = edict->client->state;
    const bool is_alive = state.stats[stat_health] > 0 && state.move.type == PM_NORMAL;
    const PlayerView view = view_of(*edict);
    const Explorer::Arrival arrival = note_arrival(view, is_alive);
    if (explorer_ && is_alive) {
        const ServerSpace space(host_, brushes_, *edict);
        explorer_->think(space, view, arrival);
    }
    if (explorer_ && is_alive && explorer_->is_trapped())
        fake_client_.type(edict, "kill");
    presses_ = !presses_; // the dead press a button again and again, as to live anew
    for (int part = 0; part < parts && is_walking(); part++) {
        UserCommand input {};
        if (is_alive)
            input = next_input(*edict);
        else
            input.buttons = presses_ ? BUTTON_ATTACK | BUTTON_ANY : 0;
        input.milliseconds = part_milliseconds;
        host_.game->client_think(edict, &input);
    }
    if (mode_ == Mode::explore && frames_left_ > 0 && --frames_left_ == 0)
        stop(fake_client_.is_fake(edict) ? nullptr : edict);
}

UserCommand Walker::next_input(const Edict& edict)
{
    const PlayerView view = view_of(edict);
    const Inputs inputs = mode_ == Mode::explore ? explorer_->steer(view, part_seconds) : follow_file(view);
    angles_ = inputs.angles;
    return make_command(edict, inputs);
}

UserCommand Walker::make_command(const Edict& edict, const Inputs& inputs) const
{
    UserCommand command {};
    const float yaw = glm::radians(inputs.angles.y);
    const glm::vec3 forward(std::cos(yaw), std::sin(yaw), 0), right(std::sin(yaw), -std::cos(yaw), 0);
    command.forward = int16_t(std::lround(glm::dot(inputs.move, forward) * run_speed));
    command.side = int16_t(std::lround(glm::dot(inputs.move, right) * run_speed));
    command.up = int16_t(std::lround(inputs.climb * jump_input));
    command.buttons = inputs.attack ? BUTTON_ATTACK | BUTTON_ANY : 0;
    // The game adds its own turns, as of spawn points and teleporters.
    const int16_t* delta = edict.client->state.move.delta_angles;
    for (int i = 0; i < 3; i++)
        command.angles[i] = int16_t(uint16_t(to_short_angle(inputs.angles[i])) - uint16_t(delta[i]));
    return command;
}

Inputs Walker::follow_file(const PlayerView& view)
{
    if (action_parts_ == 0)
        begin_action(view);
    Inputs inputs;
    inputs.angles = angles_;
    if (action_ >= actions_.size())
        return inputs;
    const WalkAction& action = actions_[action_];
    action_parts_++;
    if (std::holds_alternative<GoTo>(action))
        inputs = explorer_->steer(view, part_seconds);
    else if (const auto* look = std::get_if<Look>(&action))
        inputs.angles = look->angles;
    else if (const auto* input = std::get_if<TimedInput>(&action))
        inputs = follow_input(*input);
    else if (const auto* step = std::get_if<Step>(&action))
        inputs = follow_step(*step, view);
    if (is_done(action, view)) {
        angles_ = inputs.angles;
        next_action();
    }
    return inputs;
}

Inputs Walker::follow_input(const TimedInput& input) const
{
    Inputs inputs;
    const float share = std::min(1.0f, float(action_parts_) / float(parts_of(input.seconds)));
    inputs.angles = start_angles_;
    if (input.turns_pitch)
        inputs.angles.x += (input.angles.x - start_angles_.x) * share;
    if (input.turns_yaw)
        inputs.angles.y = wrap_degrees(start_angles_.y + wrap_degrees(input.angles.y - start_angles_.y) * share);
    const float yaw = glm::radians(inputs.angles.y);
    inputs.move = (glm::vec3(std::cos(yaw), std::sin(yaw), 0) * input.forward
                      + glm::vec3(std::sin(yaw), -std::cos(yaw), 0) * input.side)
        / run_speed;
    inputs.climb = input.up / jump_input;
    inputs.attack = input.attack;
    return inputs;
}

// The player is led along the line from the last place to this one.
Inputs Walker::follow_step(const Step& step, const PlayerView& view)
{
    Inputs inputs;
    float share = float(action_parts_) / parts;
    const bool is_teleport = glm::distance(*step_from_, step.place) > farthest_step;
    const glm::vec3 lag = (is_teleport ? step.place : glm::mix(*step_from_, step.place, share)) - view.origin;
    if (!is_teleport)
        step_velocity_ = (step.place - *step_from_) / frame_seconds;
    if (!is_teleport && find_distance_behind(lag, step_velocity_) <= farthest_lag) {
        step_waits_ = 0;
    } else if (step_waits_ < patience) {
        step_waits_++;
        action_parts_--; // the line's end waits
    }
    const glm::vec3 velocity = is_teleport ? step_velocity_ : step_velocity_ + lag / approach_seconds;
    const glm::vec3 wanted = velocity + inertia * (velocity - view.velocity);
    const float speed = level_length(wanted);
    if (speed > 8)
        inputs.move = glm::vec3(wanted.x, wanted.y, 0) / std::max(speed, run_speed);
    if (view.in_water)
        inputs.climb = std::clamp(wanted.z / run_speed, -1.0f, 1.0f);
    else
        inputs.climb = step.jump && share > step.jump_share ? 1.0f : step.duck ? -1.0f : 0.0f;
    inputs.angles.x = glm::mix(start_angles_.x, step.angles.x, share);
    inputs.angles.y = wrap_degrees(start_angles_.y + wrap_degrees(step.angles.y - start_angles_.y) * share);
    inputs.attack = step.attack;
    return inputs;
}

void Walker::begin_action(const PlayerView& view)
{
    start_angles_ = angles_;
    if (action_ >= actions_.size()) {
        stop(fake_client_.is_fake(player()) ? nullptr : player());
        return;
    }
    if (const auto* target = std::get_if<GoTo>(&actions_[action_]))
        explorer_->set_goal(target->place);
    if (!step_from_)
        step_from_ = view.origin;
}

void Walker::next_action()
{
    const auto* step = std::get_if<Step>(&actions_[action_]);
    step_from_ = step ? std::optional(step->place) : std::nullopt;
    action_++;
    action_parts_ = 0;
    explorer_->clear_goal();
    explorer_->reset_view(angles_);
}

bool Walker::is_done(const WalkAction& action, const PlayerView& view) const
{
    if (const auto* wait = std::get_if<Wait>(&action))
        return action_parts_ >= parts_of(wait->seconds);
    if (const auto* input = std::get_if<TimedInput>(&action))
        return action_parts_ >= parts_of(input->seconds);
    if (std::holds_alternative<Step>(action))
        return action_parts_ >= parts;
    if (!std::holds_alternative<GoTo>(action) || explorer_->has_arrived(view))
        return true;
    if (explorer_->has_given_up())
        host_.say(fake_client_.is_fake(player()) ? nullptr : player(),
            fmt::format("walk: {}: no way to the place of line {}; it is left out", name_, action_ + 1));
    return explorer_->has_given_up();
}

bool Walker::swallows(const Edict* client) const { return is_walking() && player() && client == player(); }

void Walker::record_input(const Edict* client, const UserCommand& command)
{
    if (mode_ != Mode::record || !player() || client != player() || !client->client)
        return;
    // Keys may be pressed for less than a step.
    if (command.up > 0 && !std::exchange(pressed_.jump, true))
        pressed_.jump_share = float(step_milliseconds_) / frame_milliseconds;
    pressed_.duck |= command.up < 0;
    pressed_.attack |= (command.buttons & BUTTON_ATTACK) != 0;
    const glm::vec3 angles = to_vec3(client->client->state.view_angles);
    pressed_.angles = { std::clamp(angles.x, -90.0f, 90.0f), wrap_degrees(angles.y), 0 };
    const glm::vec3 from = std::exchange(last_origin_, to_vec3(client->state.origin));
    const bool was_moved = glm::distance(from, last_origin_) > farthest_step;
    for (step_milliseconds_ += command.milliseconds; step_milliseconds_ >= frame_milliseconds;) {
        step_milliseconds_ -= frame_milliseconds;
        const float share = 1 - float(step_milliseconds_) / float(command.milliseconds);
        pressed_.place = was_moved ? last_origin_ : glm::mix(from, last_origin_, share);
        if (actions_.size() < max_walk_actions)
            actions_.push_back(pressed_);
        pressed_ = { .angles = pressed_.angles };
    }
}

void Walker::show_view()
{
    Edict* edict = player();
    if (!is_walking() || !edict || !edict->client || fake_client_.is_fake(edict))
        return;
    MoveState& move = edict->client->state.move;
    hidden_ = move;
    is_view_shown_ = true;
    move.type = PM_FREEZE;
    move.flags |= PMF_NO_PREDICTION;
}

void Walker::hide_view()
{
    if (!is_view_shown_)
        return;
    is_view_shown_ = false;
    MoveState& move = player()->client->state.move;
    move.type = hidden_.type;
    move.flags = hidden_.flags;
}

} // namespace vkpt::game
