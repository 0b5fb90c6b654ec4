// SPDX-License-Identifier: GPL-2.0-or-later
// The frames of our demo as the engine shows them, against stored statistics. VKPT_UPDATE_STATISTICS=1 writes them
// anew. Unfiltered: it is the sampling that is watched.
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace vkpt::tests {

namespace {

constexpr const char* statistics_file = VKPT_SOURCE_DIR "/tests/engine/demo_statistics.txt";
constexpr int capture_every = 20;

// How far a frame may be from what is stored: some times what other seeds and drivers, which round otherwise and sample
// otherwise, make of it (1 %, 1 %, 2 % and .3 points in pictures three times as large).
constexpr double mean_tolerance = 0.05; // relative
constexpr double deviation_tolerance = 0.05;
constexpr double noise_tolerance = 0.12;
constexpr double min_noise = 0.004; // two steps of 8 bits are no noise worth comparing
constexpr double black_tolerance = 0.015;

std::vector<PictureStatistics> read_statistics()
{
    std::vector<PictureStatistics> rows;
    std::ifstream file(statistics_file);
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#')
            continue;
        PictureStatistics row;
        std::istringstream(line) >> row.mean >> row.deviation >> row.noise >> row.black;
        rows.push_back(row);
    }
    return rows;
}

void write_statistics(const std::vector<PictureStatistics>& rows)
{
    std::ofstream file(statistics_file);
    file << "# SPDX-License-Identifier: GPL-2.0-or-later\n"
            "# Frames of our demo, every "
         << capture_every
         << "th: mean, deviation and noise of luminance, fraction of black pixels.\n"
            "# Made anew by: VKPT_UPDATE_STATISTICS=1 ./test -- -R engine_test.Engine\n";
    for (const PictureStatistics& row : rows)
        file << row.mean << ' ' << row.deviation << ' ' << row.noise << ' ' << row.black << '\n';
}

std::vector<PictureStatistics> play_and_measure()
{
    EngineOptions options;
    options.width = 192;
    options.height = 108;
    options.render_scale = 100;
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+set", "pt_capture_every",
        std::to_string(capture_every), "+set", "flt_denoiser", "off", "+set", "flt_taa", "off", "+set", "pt_bloom", "0",
        "+set", "timedemo", "1", "+set", "cl_predict", "0", "+set", "nextdemo", "quit", "+demomap", own_demo };
    const EngineRun run(options);
    run.expect_clean();
    std::vector<PictureStatistics> rows;
    for (const auto& path : list_pictures(run.captures())) {
        const formats::Image picture = load_picture(path);
        EXPECT_EQ(picture.width, options.width);
        EXPECT_EQ(picture.height, options.height);
        rows.push_back(measure_picture(picture));
    }
    return rows;
}

} // namespace

TEST(Engine, DemoFramesAreAsTheyShouldBe)
{
    const auto seen = play_and_measure();
    ASSERT_GE(seen.size(), 8u) << "too few frames were captured";
    if (std::getenv("VKPT_UPDATE_STATISTICS"))
        write_statistics(seen);
    const auto stored = read_statistics();
    ASSERT_EQ(seen.size(), stored.size()) << statistics_file << " is of another demo";
    for (size_t i = 0; i < seen.size(); i++) {
        SCOPED_TRACE("captured frame " + std::to_string(i + 1));
        EXPECT_GT(seen[i].mean, 0.02) << "nearly black";
        EXPECT_LT(seen[i].mean, 0.95) << "nearly white";
        EXPECT_GT(seen[i].deviation, 0.01) << "nothing to be seen";
        EXPECT_LT(seen[i].black, 0.5) << "half of the picture is black";
        EXPECT_NEAR(seen[i].mean, stored[i].mean, mean_tolerance * stored[i].mean);
        EXPECT_NEAR(seen[i].deviation, stored[i].deviation, deviation_tolerance * stored[i].deviation);
        EXPECT_NEAR(seen[i].noise, stored[i].noise, noise_tolerance * stored[i].noise + min_noise);
        EXPECT_NEAR(seen[i].black, stored[i].black, black_tolerance);
    }
}

} // namespace vkpt::tests
