// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/fake_client.hpp"

#include <array>
#include <string_view>

namespace vkpt::game {

bool FakeClient::connect(const std::vector<bool>& is_client)
{
    constexpr size_t longest_user_info = 512;
    constexpr std::string_view user_info = "\\name\\walker\\skin\\male/grunt\\hand\\2\\fov\\90\\ip\\loopback";
    for (int number = 1; number <= host_.client_count(); number++) {
        if (is_client[size_t(number)])
            continue;
        std::array<char, longest_user_info> text {};
        user_info.copy(text.data(), text.size() - 1);
        number_ = number;
        host_.edict(number)->state.number = number;
        if (is_true(host_.game->client_connect(host_.edict(number), text.data()))) {
            begin();
            return true;
        }
        number_ = 0;
    }
    return false;
}

void FakeClient::begin()
{
    if (number_ > 0)
        host_.game->client_begin(host_.edict(number_));
}

void FakeClient::disconnect()
{
    if (number_ > 0)
        host_.game->client_disconnect(host_.edict(number_));
    number_ = 0;
}

void FakeClient::type(Edict* edict, const char* word)
{
    word_ = word;
    host_.game->client_command(edict);
    word_ = nullptr;
}

void FakeClient::drop_message() const
{
    // The server forgets a message once it is sent. Nobody sees a place outside of the map.
    constexpr glm::vec3 outside(65536);
    host_.engine.multicast(&outside.x, MULTICAST_PVS);
}

} // namespace vkpt::game
