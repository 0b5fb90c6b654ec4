// SPDX-License-Identifier: GPL-2.0-or-later
// sound/: short synthesised effects, 22,050 Hz, 16 bit, mono.
#include "formats/wav.hpp"
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/output.hpp"
#include "tools/asset_generator/tau.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace vkpt::tools {

namespace {
constexpr int sample_rate = 22050;

// Amplitude -1..1 at `t` seconds; `u` runs 0..1 through the sound.
using Voice = std::function<float(float t, float u)>;

float hiss(float t, float rate) // held noise: `rate` new values a second, joined smoothly
{
    const float at = t * rate, base = std::floor(at);
    const float a = hash_unit(int(base), 1, 801) * 2 - 1, b = hash_unit(int(base) + 1, 1, 801) * 2 - 1;
    return a + (b - a) * (at - base);
}
float sweep(float t, float from, float to, float seconds) // sine whose frequency falls or rises exponentially
{
    const float k = std::log(to / from) / seconds;
    return std::sin(tau * from * (std::exp(k * t) - 1) / k);
}

// `loops`: a cue chunk at sample 0, which makes the engine repeat the sound.
std::vector<std::byte> make_wav(const Voice& voice, float seconds, bool loops)
{
    const uint32_t count = uint32_t(seconds * sample_rate), data_size = count * 2, cue_size = loops ? 36 : 0;
    formats::WavFormat format;
    format.rate = sample_rate;
    std::vector<std::byte> file = formats::make_wav_header(format, data_size, cue_size);
    const auto text = [&](const char* four) {
        for (int i = 0; i < 4; i++)
            file.push_back(std::byte(four[i]));
    };
    const auto number = [&](uint32_t value, int bytes) {
        for (int i = 0; i < bytes; i++)
            file.push_back(std::byte(value >> (8 * i)));
    };
    for (uint32_t i = 0; i < count; i++) {
        const float t = float(i) / sample_rate, u = float(i) / float(count);
        const float edge = loops ? 1.0f : std::min(1.0f, std::min(u, 1 - u) * 60); // no clicks
        const float value = std::clamp(voice(t, u) * edge, -1.0f, 1.0f);
        number(uint32_t(uint16_t(int16_t(std::lround(value * 30000)))), 2);
    }
    if (loops) {
        text("cue "), number(28, 4), number(1, 4);
        number(1, 4), number(0, 4), text("data"), number(0, 4), number(0, 4), number(0, 4);
    }
    return file;
}

float thump(float t, float pitch, float decay) { return sweep(t, pitch, pitch * 0.4f, 0.2f) * std::exp(-t * decay); }
float knock(float t, float seed) { return hiss(t + seed, 5200) * std::exp(-t * 70) + 0.8f * thump(t, 150, 40); }
float chime(float t, float note, float decay)
{
    return (std::sin(tau * note * t) + 0.4f * std::sin(tau * note * 2.01f * t)) * 0.5f * std::exp(-t * decay);
}
float motor(float t, float pitch)
{
    return 0.4f * std::sin(tau * pitch * t) + 0.25f * std::sin(tau * pitch * 2 * t) + 0.2f * hiss(t, 1800);
}
float groan(float t, float u, float pitch) // a short breathy vowel: pulses through two resonances
{
    const float f = pitch * (1.1f - 0.4f * u);
    const float pulse = std::pow(0.5f + 0.5f * std::sin(tau * f * t), 6.0f);
    const float vowel = std::sin(tau * 620 * t) * 0.5f + std::sin(tau * 1080 * t) * 0.3f;
    return (pulse * vowel * 1.4f + 0.12f * hiss(t, 7000)) * std::sin(3.1416f * std::sqrt(u));
}

// Writes them by name.
struct Sounds {
    const Output& out;

    void put(const std::string& name, float seconds, const Voice& voice, bool loops = false) const
    {
        out.write("sound/" + name + ".wav", make_wav(voice, seconds, loops));
    }
    void shot(const char* name, float seconds, float pitch, float decay, float rate) const
    {
        put(name, seconds, [=](float t, float) {
            return 0.8f * hiss(t, rate) * std::exp(-t * decay) + 0.7f * thump(t, pitch, decay * 0.6f);
        });
    }
    void zap(const char* name, float seconds, float from, float to, float decay) const
    {
        put(name, seconds, [=](float t, float) {
            return (0.55f * sweep(t, from, to, seconds) + 0.3f * sweep(t, from * 1.51f, to * 1.51f, seconds)
                       + 0.15f * hiss(t, 9000))
                * std::exp(-t * decay);
        });
    }
    void pickup(const char* name, float low, float high) const
    {
        put(name, 0.34f, [=](float t, float) {
            return 0.45f * chime(t, low, 11) + 0.45f * chime(std::max(t - 0.07f, 0.0f), high, 10);
        });
    }
    void write_notices() const;
    void write_steps() const;
    void write_body() const;
    void write_weapons() const;
    void write_machines() const;
    void write_pickups() const;
    void write_loops() const;
};

// Menus and notices.
void Sounds::write_notices() const
{
    put("misc/menu1", 0.12f, [](float t, float) { return 0.5f * chime(t, 660, 24); });
    put("misc/menu2", 0.07f, [](float t, float) { return 0.4f * chime(t, 990, 40); });
    put("misc/menu3", 0.14f, [](float t, float) { return 0.5f * chime(t, 440, 22); });
    put("misc/talk", 0.10f, [](float t, float) { return 0.5f * chime(t, 1320, 30); });
    put("misc/talk1", 0.10f, [](float t, float) { return 0.5f * chime(t, 1180, 30); });
    put("misc/secret", 0.9f,
        [](float t, float) { return 0.4f * chime(t, 523, 4) + 0.4f * chime(std::max(t - 0.18f, 0.0f), 784, 4); });
}

// Walking, falling, swimming.
void Sounds::write_steps() const
{
    for (int i = 1; i <= 4; i++)
        put("player/step" + std::to_string(i), 0.14f, [i](float t, float) { return 0.5f * knock(t, float(i)); });
    put("player/land1", 0.25f, [](float t, float) { return 0.7f * knock(t, 9) + 0.4f * thump(t, 90, 18); });
    put("world/land", 0.25f, [](float t, float) { return 0.6f * knock(t, 11) + 0.3f * thump(t, 80, 18); });
    put("player/fall1", 0.4f, [](float t, float u) { return groan(t, u, 115) + 0.5f * knock(t, 5); });
    put("player/fall2", 0.45f, [](float t, float u) { return groan(t, u, 98) + 0.5f * knock(t, 6); });
    put("player/watr_in", 0.5f, [](float t, float u) { return hiss(t, 2600 - 1800 * u) * std::exp(-t * 6) * 0.7f; });
    put("player/watr_out", 0.45f, [](float t, float u) { return hiss(t, 1200 + 2600 * u) * std::exp(-t * 7) * 0.6f; });
    put("player/watr_un", 0.6f, [](float t, float u) { return hiss(t, 700) * std::sin(3.14f * u) * 0.6f; });
    put("misc/h2ohit1", 0.3f, [](float t, float) { return hiss(t, 3000) * std::exp(-t * 12) * 0.5f; });
    put("player/gasp1", 0.4f, [](float t, float u) { return hiss(t, 6000) * std::sin(3.14f * u) * 0.35f; });
    put("player/gasp2", 0.5f, [](float t, float u) { return hiss(t, 5000) * std::sin(3.14f * u) * 0.4f; });
    for (const char* name :
        { "player/lava1", "player/lava2", "player/lava_in", "player/burn1", "player/burn2", "player/fry" })
        put(name, 0.6f, [](float t, float u) { return hiss(t, 8000) * (1 - u) * 0.4f * (0.6f + 0.4f * hiss(t, 40)); });
}

// The body.
void Sounds::write_body() const
{
    put("player/male/jump1", 0.22f, [](float t, float u) { return 0.6f * groan(t, u, 150); });
    for (const char* name :
        { "pain100_1", "pain100_2", "pain75_1", "pain75_2", "pain50_1", "pain50_2", "pain25_1", "pain25_2" }) {
        const float pitch = 100 + float(std::strlen(name) * 7 % 23) + float(name[4] - '0') * 3;
        put(std::string("player/male/") + name, 0.32f, [pitch](float t, float u) { return 0.8f * groan(t, u, pitch); });
    }
    for (int i = 1; i <= 4; i++)
        put("player/male/death" + std::to_string(i), 0.9f,
            [i](float t, float u) { return 0.9f * groan(t, u, 120 - 8 * float(i)) * (1 - 0.5f * u); });
    put("player/male/fall1", 0.4f, [](float t, float u) { return groan(t, u, 115); });
    put("player/male/fall2", 0.45f, [](float t, float u) { return groan(t, u, 98); });
    for (int i = 1; i <= 2; i++)
        put("player/male/gurp" + std::to_string(i), 0.5f,
            [](float t, float u) { return groan(t, u, 90) * (0.5f + 0.5f * std::sin(tau * 9 * t)); });
    put("misc/udeath", 0.6f, [](float t, float) { return hiss(t, 1800) * std::exp(-t * 7) * 0.8f; });
    put("misc/fhit3", 0.25f, [](float t, float) { return hiss(t, 1500) * std::exp(-t * 16) * 0.6f; });
}

// Weapons.
void Sounds::write_weapons() const
{
    zap("weapons/blastf1a", 0.32f, 1500, 210, 8);
    zap("weapons/hyprbf1a", 0.22f, 1900, 320, 10);
    zap("weapons/railgf1a", 0.8f, 2400, 90, 4);
    zap("weapons/bfg__f1y", 1.2f, 60, 420, 1.2f);
    zap("weapons/bfg__x1b", 1.0f, 500, 40, 3);
    zap("weapons/laser2", 0.2f, 1700, 500, 8);
    zap("weapons/lashit", 0.2f, 900, 1600, 14);
    zap("misc/tele1", 0.8f, 200, 1800, 2);
    zap("items/respawn1", 0.7f, 300, 1200, 3);
    for (const char* name :
        { "weapons/machgf1b", "weapons/machgf2b", "weapons/machgf3b", "weapons/machgf4b", "weapons/machgf5b" })
        shot(name, 0.2f, 170, 22, 7000);
    shot("weapons/shotgf1b", 0.45f, 120, 11, 5200);
    shot("weapons/sshotf1b", 0.6f, 90, 8, 4600);
    shot("weapons/grenlf1a", 0.35f, 140, 14, 2600);
    shot("weapons/hgrent1a", 0.25f, 240, 18, 3600);
    shot("weapons/rocklf1a", 0.7f, 100, 5, 3800);
    shot("weapons/grenlx1a", 1.2f, 60, 4, 1500);
    shot("weapons/rocklx1a", 1.3f, 55, 3.6f, 1300);
    shot("weapons/xpld_wat", 1.1f, 48, 4, 600);
    for (const char* name : { "weapons/shotgr1b", "weapons/grenlr1b", "weapons/rocklr1b", "weapons/noammo",
             "weapons/grenlb1b", "weapons/hgrenb1a", "weapons/hgrenb2a", "weapons/hgrenc1b", "weapons/hgrena1b" })
        put(name, 0.16f,
            [](float t, float) { return 0.4f * hiss(t, 8000) * std::exp(-t * 50) + 0.4f * chime(t, 1700, 50); });
    for (int i = 1; i <= 3; i++) {
        const float note = 2100 + 320 * float(i);
        put("world/ric" + std::to_string(i), 0.3f,
            [note](float t, float) { return 0.4f * sweep(t, note, note * 0.5f, 0.3f) * std::exp(-t * 9); });
    }
    for (int i = 5; i <= 7; i++)
        put("world/spark" + std::to_string(i), 0.18f,
            [i](float t, float) { return 0.4f * hiss(t, 6000 + 900 * float(i)) * std::exp(-t * 24); });
}

// Doors, lifts, switches.
void Sounds::write_machines() const
{
    for (const char* kind : { "doors/dr1", "plats/pt1" }) {
        const float pitch = kind[0] == 'd' ? 70 : 52;
        put(std::string(kind) + "_strt", 0.3f,
            [=](float t, float u) { return (0.6f * motor(t, pitch) * u + 0.5f * knock(t, 3)); });
        put(
            std::string(kind) + "_mid", 1.0f, [=](float t, float) { return 0.45f * motor(t, pitch); }, true);
        put(std::string(kind) + "_end", 0.35f,
            [=](float t, float u) { return 0.5f * motor(t, pitch * (1 - 0.4f * u)) * (1 - u) + 0.6f * knock(t, 4); });
    }
    put("switches/butn2", 0.15f, [](float t, float) { return 0.6f * knock(t, 8); });
    put("misc/trigger1", 0.15f, [](float t, float) { return 0.5f * knock(t, 8); });
}

// Things taken and used.
void Sounds::write_pickups() const
{
    pickup("items/pkup", 520, 780), pickup("misc/w_pkup", 330, 660), pickup("misc/am_pkup", 440, 550);
    pickup("misc/ar1_pkup", 360, 540), pickup("misc/ar2_pkup", 300, 600), pickup("misc/ar3_pkup", 660, 880);
    pickup("items/s_health", 700, 930), pickup("items/n_health", 620, 930), pickup("items/l_health", 520, 1040);
    pickup("items/m_health", 440, 1100), pickup("misc/pc_up", 500, 1000), pickup("misc/power1", 400, 800),
        pickup("misc/power2", 800, 400);
    pickup("items/damage", 220, 330), pickup("items/damage2", 330, 220), pickup("items/damage3", 220, 165);
    pickup("items/protect", 600, 900), pickup("items/protect2", 900, 600), pickup("items/protect4", 600, 1200);
    pickup("misc/keyuse", 500, 750), pickup("misc/keytry", 300, 250), pickup("items/airout", 400, 300);
}

// Long ones.
void Sounds::write_loops() const
{
    put(
        "misc/lasfly", 0.6f,
        [](float t, float) { return 0.25f * std::sin(tau * 200 * t) * (0.7f + 0.3f * std::sin(tau * 10 * t)); }, true);
    put(
        "weapons/rockfly", 0.8f, [](float t, float) { return 0.35f * hiss(t, 1600); }, true);
    put(
        "weapons/rg_hum", 1.0f, [](float t, float) { return 0.2f * std::sin(tau * 90 * t); }, true);
    put(
        "weapons/bfg_hum", 1.0f,
        [](float t, float) { return 0.25f * std::sin(tau * 60 * t) + 0.1f * std::sin(tau * 180 * t); }, true);
    put(
        "world/amb10", 2.0f,
        [](float t, float) { return 0.12f * std::sin(tau * 50 * t) + 0.05f * std::sin(tau * 100 * t); }, true);
}

} // namespace

void write_sounds(const Output& out)
{
    const Sounds sounds { out };
    sounds.write_notices();
    sounds.write_steps();
    sounds.write_body();
    sounds.write_weapons();
    sounds.write_machines();
    sounds.write_pickups();
    sounds.write_loops();
}

} // namespace vkpt::tools
