// SPDX-License-Identifier: GPL-2.0-or-later
// What changes from frame to frame is all that is written, and the copy is always whole.
#include "ref_vkpt/frame/changes.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {
namespace {

class Copy {
public:
    explicit Copy(size_t room)
        : target_(room)
    {
    }
    size_t write(const std::vector<std::byte>& now)
    {
        const size_t written = write_changes(target_.data(), held_, now);
        EXPECT_EQ(held_, now);
        EXPECT_TRUE(std::equal(now.begin(), now.end(), target_.begin()));
        return written;
    }

private:
    std::vector<std::byte> target_, held_;
};

TEST(WriteChanges, WritesNothingWhereNothingChanged)
{
    Copy copy(100000);
    const std::vector<std::byte> items(50000, std::byte(7));
    EXPECT_EQ(copy.write(items), items.size());
    EXPECT_EQ(copy.write(items), 0u);
}

TEST(WriteChanges, WritesLittleWhereLittleChanged)
{
    Copy copy(100000);
    std::vector<std::byte> items(50000, std::byte(7));
    copy.write(items);
    items[20000] = std::byte(8);
    const size_t written = copy.write(items);
    EXPECT_GT(written, 0u);
    EXPECT_LE(written, 512u);
}

TEST(WriteChanges, FollowsEverySizeAndContent)
{
    Copy copy(4096);
    std::mt19937 random(1);
    std::vector<std::byte> items;
    for (int round = 0; round < 2000; round++) {
        items.resize(random() % 4097, std::byte(random()));
        for (unsigned change = random() % 4; change > 0 && !items.empty(); change--)
            items[random() % items.size()] = std::byte(random());
        copy.write(items);
    }
}

} // namespace
} // namespace vkpt::tests
