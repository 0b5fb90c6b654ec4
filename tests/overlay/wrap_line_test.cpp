// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/wrap_line.hpp"

#include <gtest/gtest.h>

namespace vkpt {

using Parts = std::vector<std::string>;

TEST(WrapLine, ShortLinesStayAsTheyAre)
{
    EXPECT_EQ(wrap_line("", 20), Parts { "" });
    EXPECT_EQ(wrap_line("twenty characters...", 20), Parts { "twenty characters..." });
}

TEST(WrapLine, BreaksAtBlanks)
{
    EXPECT_EQ(wrap_line("ERROR: lib/sky.glsl:12: 'texel' : undeclared identifier", 26),
        (Parts { "ERROR: lib/sky.glsl:12:", "  'texel' : undeclared", "  identifier" }));
    EXPECT_EQ(wrap_line("exactly ten fits", 11), (Parts { "exactly ten", "  fits" }));
}

TEST(WrapLine, BreaksWordsThatAreTooLong)
{
    EXPECT_EQ(wrap_line("0123456789abcdef", 10), (Parts { "0123456789", "  abcdef" }));
}

// No window is too narrow.
TEST(WrapLine, LosesNothing)
{
    const std::string text = "a shader's name, a place and, at last, what is wrong: unexpected IDENTIFIER";
    for (size_t columns = 0; columns < 100; columns++) {
        std::string letters, wanted;
        for (const std::string& part : wrap_line(text, columns)) {
            EXPECT_LE(part.size(), std::max(columns, size_t(8)));
            letters += part;
        }
        std::erase(letters, ' ');
        wanted = text;
        std::erase(wanted, ' ');
        EXPECT_EQ(letters, wanted) << columns;
    }
}

} // namespace vkpt
