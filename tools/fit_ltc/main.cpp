// SPDX-License-Identifier: GPL-2.0-or-later
// fit_ltc FILE: writes the table as C++.
#include "tools/fit_ltc/fit.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

namespace {

constexpr const char* head = R"(// SPDX-License-Identifier: GPL-2.0-or-later
// Made by tools/fit_ltc (its CMakeLists.txt has the command): do not edit. Layout: shaders/shared/ltc.h.
// clang-format off
#include "ref_vkpt/lights/ltc_table.hpp"

const std::array<float, vkpt::ltc_table_size> vkpt::ltc_table {
)";

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "use: fit_ltc FILE\n");
        return 2;
    }
    std::string text = head;
    double worst = 0, sum = 0;
    const std::vector<vkpt::ltc::Entry> table = vkpt::ltc::fit_table();
    for (const vkpt::ltc::Entry& e : table) {
        text += fmt::format(
            "{:.6g}f,{:.6g}f,{:.6g}f,{:.6g}f,{:.6g}f,{:.6g}f,\n", e.xx, e.xz, e.yy, e.zx, e.albedo, e.grazing);
        worst = std::max(worst, e.error);
        sum += e.error;
    }
    // 1f is no C++ literal, 1.f is.
    for (size_t at = 0; (at = text.find("f,", at)) != std::string::npos; at += 2) {
        const size_t start = text.find_last_of(",\n", at - 1) + 1;
        if (text.find_first_of(".e", start) > at) {
            text.insert(at, 1, '.');
            at++;
        }
    }
    text += "};\n";
    std::FILE* file = std::fopen(argv[1], "w");
    if (!file || std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fclose(file) != 0) {
        std::fprintf(stderr, "fit_ltc: cannot write %s\n", argv[1]);
        return 1;
    }
    std::printf("%zu entries, error mean %.4f, worst %.4f\n", table.size(), sum / double(table.size()), worst);
    return 0;
}
