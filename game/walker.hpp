// SPDX-License-Identifier: GPL-2.0-or-later
// The scripted player: the command `walk`, and what drives a player by it, the same way in every run.
#pragma once

#include "game/explorer.hpp"
#include "game/fake_client.hpp"
#include "game/host.hpp"
#include "game/server_space.hpp"
#include "game/walk_text.hpp"

#include <memory>
#include <optional>

namespace vkpt::game {

class Walker {
public:
    Walker(Host& host, FakeClient& fake_client)
        : host_(host)
        , fake_client_(fake_client)
    {
    }

    // `is_client`: numbers of players that the server has.
    void run(const Command& command, const std::vector<bool>& is_client);
    void begin_level(std::string_view entity_text);
    // Before each server frame of the game's: the driven player's inputs.
    void drive();
    // True: the walk drives that player, and its own inputs are not to count.
    bool swallows(const Edict* client) const;
    // Behind each input of a player's: where it is after every tenth of a second of its own time, of which a slow
    // machine may put two into one server frame and none into the next.
    void record_input(const Edict* client, const UserCommand& command);

    // So that the driven player's screen shows what the server says, blended, and not what its own keys would do: what
    // the server tells of the player between calls into the game.
    void show_view();
    void hide_view();
    bool is_walking() const { return mode_ == Mode::file || mode_ == Mode::explore; }

private:
    enum class Mode { none, file, record, explore };

    TextFiles files() const;
    void start(Mode mode, const Command& command, const std::vector<bool>& is_client);
    void stop(Edict* asker);
    void save_record(Edict* asker);
    void explore(const Command& command, const std::vector<bool>& is_client);
    // What is seen of the map, and how much of what is known.
    std::string describe_tour() const;

    Edict* player() const { return player_ > 0 ? host_.edict(player_) : nullptr; }
    PlayerView view_of(const Edict& edict) const;
    Explorer::Arrival note_arrival(const PlayerView& view, bool is_alive);
    // The inputs of one part of a frame.
    UserCommand next_input(const Edict& edict);
    Inputs follow_file(const PlayerView& view);
    Inputs follow_step(const Step& step, const PlayerView& view);
    Inputs follow_input(const TimedInput& input) const;
    void begin_action(const PlayerView& view);
    bool is_done(const WalkAction& action, const PlayerView& view) const;
    void next_action();
    UserCommand make_command(const Edict& edict, const Inputs& inputs) const;

    Host& host_;
    FakeClient& fake_client_;
    BrushEntities brushes_;
    Mode mode_ = Mode::none;
    int player_ = 0; // its number
    int level_frame_ = 0; // at which it began
    std::unique_ptr<Explorer> explorer_;
    int frames_left_ = 0; // of explore; < 0: for ever
    std::string name_; // of the file
    std::vector<WalkAction> actions_;
    size_t action_ = 0;
    int action_parts_ = 0; // parts of frames since it began
    std::optional<glm::vec3> step_from_; // where a step's line begins
    glm::vec3 step_velocity_ { 0 }; // of the last step, in units a second
    int step_waits_ = 0; // parts that the player has been too far behind
    glm::vec3 angles_ { 0 }, start_angles_ { 0 };
    Step pressed_; // what was pressed since the last recorded step
    int step_milliseconds_ = 0; // since then, of the recorded player's time
    glm::vec3 last_origin_ { 0 };
    bool was_alive_ = true, presses_ = false;
    bool must_begin_ = false; // the fake client, in a new level
    MoveState hidden_; // what show_view() has covered
    bool is_view_shown_ = false;
};

} // namespace vkpt::game
