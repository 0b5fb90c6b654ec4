// SPDX-License-Identifier: GPL-2.0-or-later
#include "fuzz/support/records.hpp"

namespace vkpt::fuzz {

File mutate_numbers(const File& file, size_t limit, Random& random)
{
    if (file.empty() || pick(random, 3) == 0)
        return mutate_bytes(file, limit, random);
    File result = file;
    // Fields need not lie at multiples of four: from any byte on.
    for (size_t changes = 1 + pick(random, 4); changes > 0; changes--)
        mutate_field(result, pick(random, result.size()), 4, random);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz
