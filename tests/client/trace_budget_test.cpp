// SPDX-License-Identifier: GPL-2.0-or-later
// Traces made to take a machine's memory and time: no file under 1 MB gets more than 512 MB or 5 seconds of a CPU.
#include "client/trace/call_codec.hpp"
#include "client/trace/file_format.hpp"
#include "client/trace/view_codec.hpp"
#include "tests/client/run_program.hpp"

#include <cstdio>
#include <functional>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using namespace vkpt::trace;

constexpr size_t max_bytes = 1'000'000;
constexpr double max_mib = 512, max_seconds = 5;

// Calls in a trace's coding.
class Coding {
public:
    Coding& call(CallKind kind, const std::string& name = "", const std::string& text = "")
    {
        Call call;
        call.kind = kind;
        call.name = name;
        call.text = text;
        return add(call);
    }
    Coding& add(Call call)
    {
        calls_.code(encoder_, call);
        return *this;
    }
    Coding& view(size_t particles = 0, size_t entities = 0)
    {
        View view;
        view.particles.resize(particles);
        view.entities.resize(entities);
        view.has_lightstyles = true;
        call(CallKind::render_view);
        views_.code(encoder_, view);
        return *this;
    }
    // What was coded since the last time.
    std::string take()
    {
        const std::vector<std::byte> bytes = encoder_.take();
        return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
    }

private:
    Encoder encoder_;
    CallCodec calls_;
    ViewCodec views_;
};

std::string repeat(const std::string& text, size_t times)
{
    std::string result;
    result.reserve(text.size() * times);
    for (size_t i = 0; i < times; i++)
        result += text;
    return result;
}

template <class Header> std::string bytes_of(Header header)
{
    header.crc = header_crc(header);
    return { reinterpret_cast<const char*>(&header), sizeof header };
}

std::string pack(const std::string& raw)
{
    std::string packed(compressBound(uLong(raw.size())), '\0');
    uLongf size = uLong(packed.size());
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
        uLong(raw.size()), Z_BEST_COMPRESSION);
    packed.resize(size);
    const ChunkHeader header { tag_calls, uint32_t(size), uint32_t(raw.size()), 0, crc_of(packed), 0 };
    return bytes_of(header) + packed;
}

// As often as it fits into a small file.
std::string fill(const std::string& chunk) { return repeat(chunk, (max_bytes - sizeof(FileHeader)) / chunk.size()); }

const std::string begin = Coding().call(CallKind::begin_frame).take(), end = Coding().call(CallKind::end_frame).take();
constexpr size_t chunk_bytes = 32 << 20; // the largest that are read

std::string fill_frame(const std::string& start, const std::string& repeated, size_t bytes = chunk_bytes)
{
    const size_t rest = bytes - 1000 - start.size();
    return begin + start + repeat(repeated, rest / repeated.size()) + end;
}

std::string code_calls(const std::function<void(Coding&)>& code)
{
    Coding coding;
    code(coding);
    return coding.take();
}

// The first and, coded as goes on from it, the second of two.
template <class Code> std::pair<std::string, std::string> code_twice(Code code)
{
    Coding coding;
    code(coding);
    std::string first = coding.take();
    code(coding);
    return { std::move(first), coding.take() };
}

struct BadTrace {
    const char* name;
    std::string (*make)(); // its chunks
    const char* reason; // "": it may be played
};

std::string long_name_again_and_again()
{
    const auto [first, again] = code_twice([](Coding& c) { c.call(CallKind::find_pic, std::string(60'000, 'A')); });
    return pack(begin + first + repeat(again, 100'000));
}

std::string long_names_in_many_chunks()
{
    const auto [first, again] = code_twice([](Coding& c) { c.call(CallKind::find_pic, std::string(60'000, 'A')); });
    return fill(pack(begin + first + repeat(again, 2'000) + end));
}

std::string shortest_calls() { return pack(fill_frame("", Coding().call(CallKind::draw_fade).take())); }

std::string shortest_calls_in_many_chunks()
{
    return fill(pack(fill_frame("", Coding().call(CallKind::draw_fade).take(), 900'000)));
}

std::string shortest_calls_outside_of_frames()
{
    return fill(pack(repeat(Coding().call(CallKind::draw_fade).take(), 900'000)));
}

std::string many_names()
{
    return pack(code_calls([](Coding& c) {
        c.call(CallKind::begin_frame);
        for (int i = 0; i < 300'000; i++)
            c.call(CallKind::find_pic, std::to_string(i));
    }));
}

std::string empty_views()
{
    const auto [first, again] = code_twice([](Coding& c) { c.view(); });
    return pack(fill_frame(first, again));
}

std::string empty_frames()
{
    const auto [first, again]
        = code_twice([](Coding& c) { c.call(CallKind::begin_frame).view().call(CallKind::end_frame); });
    return fill(pack(first + repeat(again, 20'000)));
}

std::string full_frames()
{
    const auto [first, again]
        = code_twice([](Coding& c) { c.call(CallKind::begin_frame).view(4096, 128).call(CallKind::end_frame); });
    return fill(pack(first + repeat(again, 1'000)));
}

std::string settings_in_a_frame()
{
    const auto [first, again] = code_twice([](Coding& c) { c.call(CallKind::setting, "hand", "0"); });
    return fill(pack(fill_frame(first, again, 3'000'000)));
}

std::string registrations()
{
    const auto [first, again]
        = code_twice([](Coding& c) { c.call(CallKind::register_skin, "players/male/grunt.pcx"); });
    return fill(pack(first + repeat(again, 100'000)));
}

std::string large_raw_pictures()
{
    Call call;
    call.kind = CallKind::draw_raw;
    call.data.resize(chunk_bytes - 1000);
    return fill(pack(Coding().add(call).take()));
}

// 2,000 times the same map, each name as new for whoever compares letters.
std::string files_that_take_reading()
{
    return pack(code_calls([](Coding& c) {
        for (size_t i = 0; i < 2'000; i++)
            c.call(CallKind::file, std::string(i, '/') + "maps/sample.bsp");
        c.call(CallKind::begin_frame).view().call(CallKind::end_frame);
    }));
}

std::string tiny_chunks() { return fill(pack("")); }

class TraceBudget : public testing::TestWithParam<BadTrace> { };

INSTANTIATE_TEST_SUITE_P(Made, TraceBudget,
    testing::Values(BadTrace { "LongNameAgainAndAgain", long_name_again_and_again, "so much memory" },
        BadTrace { "LongNamesInManyChunks", long_names_in_many_chunks, "more calls than any recorder" },
        BadTrace { "ShortestCalls", shortest_calls, "so much memory" },
        BadTrace { "ShortestCallsInManyChunks", shortest_calls_in_many_chunks, "more calls than any recorder" },
        BadTrace { "ShortestCallsOutsideOfFrames", shortest_calls_outside_of_frames, "more calls than any recorder" },
        BadTrace { "ManyNames", many_names, "" }, BadTrace { "EmptyViews", empty_views, "so much memory" },
        BadTrace { "EmptyFrames", empty_frames, "more calls than any recorder" },
        BadTrace { "FullFrames", full_frames, "decompresses to more than 128 times" },
        BadTrace { "SettingsInAFrame", settings_in_a_frame, "more registrations, settings" },
        BadTrace { "Registrations", registrations, "more registrations, settings" },
        BadTrace { "LargeRawPictures", large_raw_pictures, "decompresses to more than 128 times" },
        BadTrace { "FilesThatTakeReading", files_that_take_reading, "" }, BadTrace { "TinyChunks", tiny_chunks, "" }),
    [](const auto& test) { return test.param.name; });

TEST_P(TraceBudget, IsKept)
{
    const ScratchFolder folder;
    write_sample_map(folder, "sample", R"({ "classname" "worldspawn" })");
    // Larger than any real one, and read to be compared with what was recorded.
    folder.write("baseq2/maps/sample.bsp", folder.read("baseq2/maps/sample.bsp") + std::string(20'000'000, 'x'));
    const std::string file = bytes_of(FileHeader()) + GetParam().make();
    ASSERT_LE(file.size(), max_bytes);
    folder.write("bad.rtrace", file);
    const std::vector<std::string> info { "info", "bad.rtrace" },
        render { "render", "bad.rtrace", "--size", "64x64", "--spp", "1", "-o", "a.png" };
    for (const std::vector<std::string>& arguments : { info, render }) {
        const ProgramResult result = run_program(VKPT_PROGRAM, arguments, folder.path(),
            { std::string("VKPT_MODULE=") + FAKE_MODULE, "XDG_CACHE_HOME=" + (folder.path() / "cache").string() });
        EXPECT_LT(result.peak_mib, max_mib);
        EXPECT_LT(result.cpu_seconds, max_seconds);
        std::printf("%s: %.0f MiB, %.2f s\n", arguments[0].c_str(), result.peak_mib, result.cpu_seconds);
        ASSERT_NE(result.status, -1) << "it crashed";
        if (!*GetParam().reason)
            continue;
        EXPECT_EQ(result.status, 1) << result.output;
        EXPECT_NE(result.errors.find("bad.rtrace"), std::string::npos) << result.errors;
        EXPECT_NE(result.errors.find("at byte"), std::string::npos) << result.errors;
        EXPECT_NE(result.errors.find(GetParam().reason), std::string::npos) << result.errors;
    }
}

} // namespace
} // namespace vkpt::tests
