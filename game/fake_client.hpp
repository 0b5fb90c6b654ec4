// SPDX-License-Identifier: GPL-2.0-or-later
// A player whom the server does not know of: the game is told of one, as the server would. For servers without players.
#pragma once

#include "game/host.hpp"

namespace vkpt::game {

class FakeClient {
public:
    explicit FakeClient(Host& host)
        : host_(host)
    {
    }

    // In the first place that no client has; false: there is none, or the game refuses it.
    bool connect(const std::vector<bool>& is_client);
    void disconnect();
    // The level has changed: the game is to be told anew that the player is there.
    void begin();

    Edict* edict() const { return number_ > 0 ? host_.edict(number_) : nullptr; }
    // Of what the game sends to it, nothing may come to the server, which has no connection for it.
    bool is_fake(const Edict* edict) const { return number_ > 0 && edict == host_.edict(number_); }
    // Throws away what the game has written for it.
    void drop_message() const;

    // A player types a command: what the game then asks the server for is this word. `edict` may be any player's.
    void type(Edict* edict, const char* word);
    const char* typed_word() const { return word_; } // nullptr: nothing is typed

private:
    Host& host_;
    int number_ = 0;
    const char* word_ = nullptr;
};

} // namespace vkpt::game
