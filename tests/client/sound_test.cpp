// SPDX-License-Identifier: GPL-2.0-or-later
// The sound of a recording: what recording_sound.so takes from an engine's mixer, and how it is laid beside the frames.
#include "client/record/sound.hpp"
#include "client/record/sound_file.hpp"
#include "common/trace/trace_reader.hpp"
#include "common/trace/trace_writer.hpp"
#include "tests/client/run_program.hpp"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <stdexcept>

namespace vkpt::client {

namespace {

using tests::ScratchFolder;

constexpr uint32_t rate = 1000; // of the plans

// Ten frames a second; what is heard lies `lag` samples behind.
std::vector<SoundMark> make_marks(int count, int64_t lag = 0)
{
    std::vector<SoundMark> marks;
    for (int i = 0; i < count; i++)
        marks.push_back({ i * 0.1, 100 * i + lag });
    return marks;
}

TEST(PlanSound, IsOnePieceWhereTheClocksAgree)
{
    EXPECT_EQ(plan_sound(make_marks(20, 50), 9000, rate, 0, 1.5), (std::vector<SoundPiece> { { 50, 1500 } }));
    EXPECT_EQ(plan_sound(make_marks(20, 50), 9000, rate, 0.35, 0.5), (std::vector<SoundPiece> { { 400, 500 } }));
}

TEST(PlanSound, GoesOnOverSmallDifferences)
{
    std::vector<SoundMark> marks = make_marks(20);
    for (size_t i = 0; i < marks.size(); i += 3)
        marks[i].position += 15;
    EXPECT_EQ(plan_sound(marks, 9000, rate, 0.1, 1.5), (std::vector<SoundPiece> { { 100, 1500 } }));
}

// Half a second of loading between the frames 4 and 5, which the trace shows at the same time.
TEST(PlanSound, LeavesOutWhatTheTraceDoesNotShow)
{
    std::vector<SoundMark> marks = make_marks(10);
    for (size_t i = 5; i < marks.size(); i++) {
        marks[i].seconds -= 0.1;
        marks[i].position += 500;
    }
    EXPECT_EQ(plan_sound(marks, 9000, rate, 0, 0.7), (std::vector<SoundPiece> { { 0, 400 }, { 1000, 300 } }));
}

// A clock that drifts away little by little is followed as soon as it is max_sound_lag away.
TEST(PlanSound, NeverLagsMore)
{
    std::vector<SoundMark> marks = make_marks(100);
    for (size_t i = 0; i < marks.size(); i++)
        marks[i].position += int64_t(3 * i);
    int64_t at = 0;
    size_t pieces = 0;
    for (const SoundPiece& piece : plan_sound(marks, 99999, rate, 0, 9.9)) {
        for (const SoundMark& mark : marks) {
            const int64_t shown = int64_t(mark.seconds * rate + 0.5);
            const int64_t lag = piece.first + shown - at - mark.position;
            EXPECT_TRUE(shown < at || shown >= at + piece.count || std::abs(lag) <= int64_t(max_sound_lag * rate))
                << shown << ": " << lag;
        }
        at += piece.count;
        pieces++;
    }
    EXPECT_EQ(at, 9900);
    EXPECT_GT(pieces, 5u);
}

TEST(PlanSound, IsSilentBehindTheEnd)
{
    EXPECT_EQ(plan_sound(make_marks(20), 1200, rate, 1, 0.5), (std::vector<SoundPiece> { { 1000, 200 }, { -1, 300 } }));
    EXPECT_EQ(plan_sound(make_marks(20), 500, rate, 1, 0.5), (std::vector<SoundPiece> { { -1, 500 } }));
}

// recording_sound.so, as the engine and ref_record.so call it.
class SoundDevice {
public:
    explicit SoundDevice(const std::filesystem::path& file)
        : library_(dlopen(SOUND_LIBRARY, RTLD_NOW | RTLD_LOCAL))
    {
        if (!library_)
            throw std::runtime_error(dlerror());
        setenv("VKPT_SOUND", file.c_str(), 1);
    }
    ~SoundDevice()
    {
        dlclose(library_);
        unsetenv("VKPT_SOUND");
    }
    SoundDevice(const SoundDevice&) = delete;
    SoundDevice& operator=(const SoundDevice&) = delete;

    template <class Result = void, class... Arguments> Result call(const char* name, Arguments... arguments) const
    {
        return reinterpret_cast<Result (*)(Arguments...)>(dlsym(library_, name))(arguments...);
    }
    void draw_frame(bool has_view) const
    {
        call("vkpt_advance_sound", int64_t(16'000));
        if (has_view)
            call("vkpt_note_view");
    }

private:
    void* library_;
};

// The mixer of the test: each moment's number on the left, its opposite on the right.
int16_t mixed = 0;
void mix(void* user_data, uint8_t* bytes, int length)
{
    EXPECT_EQ(user_data, &mixed);
    for (int at = 0; at < length; at += 4) {
        mixed++;
        const int16_t moment[2] = { mixed, int16_t(-mixed) };
        std::memcpy(bytes + at, moment, sizeof moment);
    }
}

void* sdl3_stream = nullptr;
const SoundDevice* sdl3_device = nullptr;
void mix_for_sdl3(void* user_data, void* stream, int additional, int)
{
    EXPECT_EQ(stream, sdl3_stream);
    std::vector<uint8_t> bytes(size_t(additional), 0);
    mix(user_data, bytes.data(), additional);
    EXPECT_TRUE(
        sdl3_device->call<bool>("SDL_PutAudioStreamData", stream, static_cast<const void*>(bytes.data()), additional));
}

// SDL 2's SDL_AudioSpec.
struct Spec2 {
    int32_t rate;
    uint16_t format;
    uint8_t channels, silence;
    uint16_t samples, padding;
    uint32_t size;
    void (*callback)(void*, uint8_t*, int);
    void* user_data;
};
constexpr uint16_t signed_16_bits = 0x8010, float_32_bits = 0x8120;
Spec2 make_spec(uint16_t format = signed_16_bits) { return { 44100, format, 2, 0, 1024, 0, 0, mix, &mixed }; }

struct Spec3 {
    uint32_t format;
    int32_t channels, rate;
};

std::vector<int16_t> read_left(const std::string& file, size_t header)
{
    std::vector<int16_t> left((file.size() - header) / 4);
    for (size_t i = 0; i < left.size(); i++)
        std::memcpy(&left[i], file.data() + header + 4 * i, sizeof left[i]);
    return left;
}

// Two frames of the console, then five of the game: 705.6 moments each.
void expect_sound(const ScratchFolder& folder)
{
    const std::vector<int16_t> left = read_left(folder.read("out.sound"), sizeof(SoundFileHeader));
    ASSERT_EQ(left.size(), size_t(7 * 16 * 44100 / 1000));
    for (size_t i = 0; i < left.size(); i++)
        ASSERT_EQ(left[i], int16_t(i + 1));
    const std::string views = folder.read("out.sound.views");
    ASSERT_EQ(views.size(), 5 * sizeof(int64_t));
    for (size_t i = 0; i < 5; i++) {
        int64_t position = 0;
        std::memcpy(&position, views.data() + i * sizeof position, sizeof position);
        EXPECT_EQ(position, int64_t((i + 3) * 16 * 44100 / 1000));
    }
}

TEST(RecordingSound, TakesWhatFramesLastFromSdl2)
{
    const ScratchFolder folder;
    const SoundDevice device(folder.path() / "out.sound");
    mixed = 0;
    Spec2 wanted = make_spec(), obtained {};
    ASSERT_EQ(device.call<int>("SDL_OpenAudio", &wanted, &obtained), 0);
    EXPECT_EQ(std::memcmp(&wanted, &obtained, sizeof wanted), 0);
    device.call("SDL_PauseAudio", 0);
    for (int frame = 0; frame < 7; frame++)
        device.draw_frame(frame >= 2);
    device.call("vkpt_note_view"); // a second view of the same frame
    device.call("SDL_CloseAudio");
    device.call("vkpt_finish_sound");
    expect_sound(folder);
}

TEST(RecordingSound, TakesWhatFramesLastFromSdl3)
{
    const ScratchFolder folder;
    const SoundDevice device(folder.path() / "out.sound");
    mixed = 0;
    Spec3 wanted { signed_16_bits, 2, 44100 };
    sdl3_device = &device;
    sdl3_stream = device.call<void*>(
        "SDL_OpenAudioDeviceStream", 0xffffffffu, &wanted, mix_for_sdl3, static_cast<void*>(&mixed));
    ASSERT_NE(sdl3_stream, nullptr);
    ASSERT_TRUE(
        device.call<bool>("SDL_ResumeAudioDevice", device.call<uint32_t>("SDL_GetAudioStreamDevice", sdl3_stream)));
    for (int frame = 0; frame < 7; frame++)
        device.draw_frame(frame >= 2);
    device.call("SDL_DestroyAudioStream", sdl3_stream);
    device.call("vkpt_finish_sound");
    expect_sound(folder);
}

TEST(RecordingSound, IsSilentWhilePausedOrClosed)
{
    const ScratchFolder folder;
    const SoundDevice device(folder.path() / "out.sound");
    mixed = 0;
    Spec2 wanted = make_spec();
    ASSERT_EQ(device.call<int>("SDL_OpenAudio", &wanted, static_cast<Spec2*>(nullptr)), 0);
    device.draw_frame(true);
    device.call("SDL_PauseAudio", 0);
    device.draw_frame(true);
    device.call("SDL_CloseAudio");
    device.draw_frame(true);
    device.call("vkpt_finish_sound");
    const std::vector<int16_t> left = read_left(folder.read("out.sound"), sizeof(SoundFileHeader));
    ASSERT_EQ(left.size(), 2116u);
    EXPECT_EQ(left[704], 0);
    EXPECT_EQ(left[705], 1);
    EXPECT_EQ(left[1410], 706);
    EXPECT_EQ(left[1411], 0);
}

TEST(RecordingSound, RefusesWhatItCannotWrite)
{
    const ScratchFolder folder;
    {
        const SoundDevice device(folder.path() / "out.sound");
        Spec2 wanted = make_spec(float_32_bits);
        EXPECT_EQ(device.call<int>("SDL_OpenAudio", &wanted, static_cast<Spec2*>(nullptr)), -1);
    }
    const SoundDevice device(folder.path() / "nowhere/out.sound");
    Spec2 wanted = make_spec();
    EXPECT_EQ(device.call<int>("SDL_OpenAudio", &wanted, static_cast<Spec2*>(nullptr)), -1);
    device.draw_frame(true);
    device.call("vkpt_finish_sound");
    EXPECT_TRUE(folder.names().empty());
}

// Two seconds at ten frames a second.
void write_trace(const std::filesystem::path& path)
{
    trace::TraceWriter writer(path);
    for (int i = 0; i <= 20; i++) {
        writer.write(trace::make_call(trace::CallKind::begin_frame));
        trace::View view;
        view.refdef.time = 3 + float(i) / 10;
        writer.write(view);
        writer.write(trace::make_call(trace::CallKind::end_frame));
    }
    writer.finish();
}

// `last`: the sample that is not silent.
void write_recording(const ScratchFolder& folder, int64_t last)
{
    const SoundFileHeader header { 1000, 1, 16 };
    std::string samples(reinterpret_cast<const char*>(&header), sizeof header), views;
    samples.resize(sizeof header + 2 * 2500, '\0');
    samples[sizeof header + 2 * size_t(last)] = 77;
    for (int64_t i = 0; i <= 20; i++) {
        const int64_t position = 100 * i + 400;
        views.append(reinterpret_cast<const char*>(&position), sizeof position);
    }
    folder.write("out.sound", samples);
    folder.write("out.sound.views", views);
}

TEST(WriteSound, CutsToTheFilm)
{
    const ScratchFolder folder;
    write_trace(folder.path() / "a.rtrace");
    const trace::TraceReader reader(folder.path() / "a.rtrace");
    write_recording(folder, 1000); // 0.6 s behind the first frame
    const auto wav = folder.path() / "a.wav";
    EXPECT_EQ(write_sound(folder.path() / "out.sound", reader, 0.5, 0.25, wav), "");
    const std::string file = folder.read("a.wav");
    constexpr size_t header = 44;
    ASSERT_EQ(file.size(), header + 2 * 250);
    EXPECT_EQ(file.substr(0, 4) + file.substr(8, 8), "RIFFWAVEfmt ");
    for (size_t i = 0; i < 250; i++)
        EXPECT_EQ(file[header + 2 * i], i == 100 ? 77 : 0) << i;
}

TEST(WriteSound, SaysWhyThereIsNone)
{
    const ScratchFolder folder;
    write_trace(folder.path() / "a.rtrace");
    const trace::TraceReader reader(folder.path() / "a.rtrace");
    const auto wav = folder.path() / "a.wav";
    EXPECT_NE(write_sound(folder.path() / "out.sound", reader, 0, 1, wav).find("no sound device"), std::string::npos);
    write_recording(folder, 2000);
    EXPECT_NE(write_sound(folder.path() / "out.sound", reader, 0, 1, wav).find("nothing is heard"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(wav));
}

} // namespace
} // namespace vkpt::client
