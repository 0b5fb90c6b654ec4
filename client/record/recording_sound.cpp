// SPDX-License-Identifier: GPL-2.0-or-later
// recording_sound.so, preloaded into an engine that records with sound: it stands in for SDL's sound device, takes from
// the engine's mixer just as many samples as the recorded frames last, and writes them into the file that $VKPT_SOUND
// names. So sound and picture go by one clock, however fast the engine runs, and nothing is played. Engines built with
// SDL 2 call SDL_OpenAudio and its kin, those built with SDL 3 an audio stream. All calls come on the engine's own
// thread.
#include "client/record/sound_file.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

using vkpt::client::SoundFileHeader;

// SDL 2's, from SDL_audio.h.
struct Spec2 {
    int32_t rate;
    uint16_t format;
    uint8_t channels, silence;
    uint16_t samples, padding;
    uint32_t size;
    void (*callback)(void* user_data, uint8_t* stream, int length);
    void* user_data;
};
// SDL 3's, from SDL_audio.h.
struct Spec3 {
    uint32_t format;
    int32_t channels, rate;
};
using Callback3 = void (*)(void* user_data, void* stream, int additional, int total);

constexpr uint32_t bits_of_format = 0xff, signed_16_bits = 0x8010; // little-endian, the same in both

struct Device {
    bool is_open = false, is_paused = true;
    void (*callback2)(void*, uint8_t*, int) = nullptr;
    Callback3 callback3 = nullptr;
    void* user_data = nullptr;
    std::FILE *samples = nullptr, *views = nullptr;
    SoundFileHeader header;
    int64_t microseconds = 0; // of frames since the start
    int64_t frames = 0; // samples of each channel that are in the file
    bool has_view = false; // since the clock went on
    bool has_failed = false; // to write
    std::vector<uint8_t> block;
};
Device device; // NOLINT: SDL has one, too

constexpr int64_t second = 1'000'000; // microseconds

void write(const void* bytes, size_t size, std::FILE* file)
{
    device.has_failed |= std::fwrite(bytes, 1, size, file) != size;
}

bool open_files(const SoundFileHeader& header)
{
    if (device.samples)
        return std::memcmp(&header, &device.header, sizeof header) == 0;
    const char* path = std::getenv("VKPT_SOUND");
    if (!path || header.bits != 16 || header.rate == 0 || header.channels == 0)
        return false;
    device.samples = std::fopen(path, "wbe");
    device.views = std::fopen((std::string(path) + vkpt::client::sound_views_ending).c_str(), "wbe");
    if (!device.samples || !device.views)
        return false;
    device.header = header;
    write(&header, sizeof header, device.samples);
    return true;
}

bool open_device(uint32_t rate, int channels, uint32_t format)
{
    SoundFileHeader header;
    header.rate = rate;
    header.channels = uint16_t(channels);
    header.bits = format == signed_16_bits ? uint16_t(format & bits_of_format) : uint16_t(0);
    device.is_open = open_files(header);
    device.is_paused = true;
    return device.is_open;
}

size_t bytes_of(int64_t frames) { return size_t(frames) * device.header.channels * sizeof(int16_t); }

// What the engine mixes for so many samples; silence where it is not asked.
void take_samples(int64_t frames)
{
    device.block.assign(bytes_of(frames), 0);
    if (device.is_open && !device.is_paused && device.callback2)
        device.callback2(device.user_data, device.block.data(), int(device.block.size()));
    if (device.is_open && !device.is_paused && device.callback3) {
        device.block.clear(); // SDL_PutAudioStreamData fills it
        device.callback3(device.user_data, &device, int(bytes_of(frames)), int(bytes_of(frames)));
        device.block.resize(bytes_of(frames));
    }
    write(device.block.data(), device.block.size(), device.samples);
    device.frames += frames;
}

} // namespace

extern "C" {

// ref_record.so calls it at every frame, before it is drawn.
[[gnu::visibility("default")]] void vkpt_advance_sound(int64_t microseconds)
{
    if (!device.samples)
        return;
    device.has_view = false;
    device.microseconds += microseconds;
    if (const int64_t frames = device.microseconds * device.header.rate / second - device.frames; frames > 0)
        take_samples(frames);
}

// ref_record.so calls it for every 3D view: the sound of what it shows comes next.
[[gnu::visibility("default")]] void vkpt_note_view()
{
    if (!device.samples || device.has_view)
        return;
    device.has_view = true;
    write(&device.frames, sizeof device.frames, device.views);
}

// ref_record.so calls it at the end. What could not be written whole is no sound.
[[gnu::visibility("default")]] void vkpt_finish_sound()
{
    if (!device.samples)
        return;
    for (std::FILE*& file : { std::ref(device.samples), std::ref(device.views) })
        device.has_failed |= std::fclose(std::exchange(file, nullptr)) != 0;
    if (device.has_failed)
        std::remove(std::getenv("VKPT_SOUND"));
}

[[gnu::visibility("default")]] int SDL_OpenAudio(const Spec2* wanted, Spec2* obtained)
{
    device.callback2 = wanted->callback;
    device.user_data = wanted->user_data;
    if (!open_device(uint32_t(wanted->rate), wanted->channels, wanted->format))
        return -1;
    if (obtained)
        *obtained = *wanted;
    return 0;
}
[[gnu::visibility("default")]] void SDL_PauseAudio(int is_paused) { device.is_paused = is_paused != 0; }
[[gnu::visibility("default")]] void SDL_LockAudio() { }
[[gnu::visibility("default")]] void SDL_UnlockAudio() { }
[[gnu::visibility("default")]] void SDL_CloseAudio() { device.is_open = false; }

[[gnu::visibility("default")]] void* SDL_OpenAudioDeviceStream(
    uint32_t, const Spec3* wanted, Callback3 callback, void* user_data)
{
    device.callback3 = callback;
    device.user_data = user_data;
    return open_device(uint32_t(wanted->rate), wanted->channels, wanted->format) ? &device : nullptr;
}
[[gnu::visibility("default")]] uint32_t SDL_GetAudioStreamDevice(void*) { return 1; }
[[gnu::visibility("default")]] bool SDL_ResumeAudioDevice(uint32_t)
{
    device.is_paused = false;
    return true;
}
[[gnu::visibility("default")]] bool SDL_PauseAudioDevice(uint32_t)
{
    device.is_paused = true;
    return true;
}
[[gnu::visibility("default")]] bool SDL_PutAudioStreamData(void*, const void* bytes, int length)
{
    const auto* begin = static_cast<const uint8_t*>(bytes);
    device.block.insert(device.block.end(), begin, begin + length);
    return true;
}
[[gnu::visibility("default")]] void SDL_DestroyAudioStream(void*) { device.is_open = false; }

} // extern "C"
