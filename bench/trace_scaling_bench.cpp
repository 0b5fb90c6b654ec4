// SPDX-License-Identifier: GPL-2.0-or-later
// How a ray's time grows with the triangles of a map: the same hall, its walls and pillars cut into ever more triangles
// whose corners are displaced, traced by the software backend's traversal in a shader of its own. And how much faster
// two threads of the CPU driver are than one.
#include "bench/ray_sets.hpp"
#include "tests/trace/gpu_tracer.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <string>

namespace vkpt::tests {
namespace {

using namespace shared;

constexpr uint32_t all_rays = 0xff;

struct Options {
    int rounds = 7;
    uint32_t width = 640, height = 360;
    uint32_t most = 1'000'000;
};

// A pseudo-random displacement that depends on the place alone, so that neighbouring faces stay joined.
float bump(glm::vec3 p)
{
    return 1.5f * (std::sin(p.x * 0.37f + p.y * 0.11f) + std::sin(p.y * 0.29f + p.z * 0.23f) + std::sin(p.z * 0.41f));
}

class HallMaker {
public:
    explicit HallMaker(uint32_t cuts)
        : cuts_(cuts)
    {
    }

    // cuts x cuts squares of two triangles; the front is on the side of cross(u, v).
    void add_face(glm::vec3 corner, glm::vec3 u, glm::vec3 v)
    {
        const glm::vec3 normal = glm::normalize(glm::cross(u, v));
        const auto point = [&](uint32_t i, uint32_t j) {
            const glm::vec3 flat = corner + u * (float(i) / float(cuts_)) + v * (float(j) / float(cuts_));
            return flat + normal * bump(flat);
        };
        for (uint32_t i = 0; i < cuts_; i++)
            for (uint32_t j = 0; j < cuts_; j++) {
                const glm::vec3 a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
                add(a, b, c);
                add(a, c, d);
            }
    }

    // Walls of a box, seen from inside with `inwards`.
    void add_walls(glm::vec3 low, glm::vec3 high, bool inwards)
    {
        const glm::vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
        const auto face = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
            inwards ? add_face(corner, v, u) : add_face(corner, u, v);
        };
        face(low, x, z);
        face(low + x, y, z);
        face(low + x + y, -x, z);
        face(low + y, -y, z);
    }

    std::vector<BvhTriangle> triangles;

private:
    void add(glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        triangles.push_back({ { a, b, c }, uint32_t(triangles.size()), all_rays });
    }

    uint32_t cuts_;
};

MapScene make_hall(uint32_t cuts)
{
    constexpr float size = 2048, height = 384;
    constexpr int pillars = 8; // along each side
    HallMaker hall(cuts);
    hall.add_walls({ 0, 0, 0 }, { size, size, height }, true);
    hall.add_face({ 0, 0, 0 }, { size, 0, 0 }, { 0, size, 0 });
    hall.add_face({ 0, 0, height }, { 0, size, 0 }, { size, 0, 0 });
    for (int i = 0; i < pillars * pillars; i++) {
        const glm::vec3 at = glm::vec3(float(i % pillars) + 0.5f, float(i / pillars) + 0.5f, 0) * (size / pillars);
        hall.add_walls(at - glm::vec3(24, 24, 0), at + glm::vec3(24, 24, height), false);
    }
    MapScene scene;
    scene.triangles = std::move(hall.triangles);
    scene.eye = { 100, 128, 180 };
    scene.yaw = 40;
    return scene; // without lights, shadow rays go to random triangles
}

struct Traced {
    RaySet set;
    std::unique_ptr<GpuTracer> tracer;
};

// One hall on one device, ready to be traced.
class Contender {
public:
    Contender(HeadlessCompute& device, const MapScene& scene, const Options& options)
        : pipelines_(create_trace_pipelines(device))
        , tree_(build_bvh(scene.triangles, BvhQuality::best))
    {
        std::vector<TestRay> camera = camera_rays(scene, { options.width, options.height });
        GpuTracer first(device, std::span(&tree_, 1), camera, all_rays);
        first.run(pipelines_[0]);
        for (RaySet& set : make_ray_sets(scene, std::move(camera), first.hits())) {
            auto tracer = std::make_unique<GpuTracer>(device, std::span(&tree_, 1), set.rays, all_rays);
            tracer->run(pipelines_[set.any_hit]);
            sets_.push_back({ std::move(set), std::move(tracer) });
        }
    }

    std::span<const Traced> sets() const { return sets_; }
    void run(const Traced& traced) const { traced.tracer->run(pipelines_[traced.set.any_hit]); }

private:
    std::array<HeadlessCompute::Pipeline, 2> pipelines_;
    Bvh tree_;
    std::vector<Traced> sets_;
};

void report_scaling(const Options& options)
{
    // 262 faces: 2 * 262 * cuts^2 triangles
    HeadlessCompute device(HeadlessCompute::Validation::off);
    std::printf("device: %s\nns of CPU time per ray, then relative to the first row\n", device.device_name().c_str());
    std::vector<Contender> halls;
    std::vector<size_t> counts;
    for (const uint32_t cuts : { 1u, 3u, 9u, 14u, 31u, 44u }) {
        const MapScene scene = make_hall(cuts);
        if (scene.triangles.size() > options.most * 5ull / 4)
            break;
        counts.push_back(scene.triangles.size());
        halls.emplace_back(device, scene, options);
    }
    std::vector<std::array<std::vector<double>, 3>> times(halls.size());
    for (int round = 0; round < options.rounds; round++)
        for (size_t hall = 0; hall < halls.size(); hall++)
            for (size_t set = 0; set < 3; set++) {
                const Traced& traced = halls[hall].sets()[set];
                times[hall][set].push_back(
                    cpu_seconds_of([&] { halls[hall].run(traced); }) / double(traced.set.rays.size()));
            }
    for (size_t hall = 0; hall < halls.size(); hall++) {
        std::printf("%8zu triangles", counts[hall]);
        for (size_t set = 0; set < 3; set++) {
            std::vector<double> ratios;
            for (size_t round = 0; round < times[hall][set].size(); round++)
                ratios.push_back(times[hall][set][round] / times[0][set][round]);
            std::printf(
                "  %s %6.1f x%.2f", halls[hall].sets()[set].set.name, median(times[hall][set]) * 1e9, median(ratios));
        }
        std::printf("\n");
    }
}

// CPU seconds of every thread of this process so far.
std::map<std::string, double> thread_seconds()
{
    std::map<std::string, double> seconds;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "schedstat"); // nanoseconds on a CPU, then other figures
        double nanoseconds = 0;
        file >> nanoseconds;
        seconds[task.path().filename()] = nanoseconds * 1e-9;
    }
    return seconds;
}

double busiest_thread_seconds_of(const std::function<void()>& work)
{
    const std::map<std::string, double> before = thread_seconds();
    work();
    double busiest = 0;
    for (const auto& [thread, seconds] : thread_seconds()) {
        const auto earlier = before.find(thread);
        busiest = std::max(busiest, seconds - (earlier == before.end() ? 0 : earlier->second));
    }
    return busiest;
}

// The CPU driver reads the number of threads when a device is made, and gives each a fixed share of a dispatch. What
// the busiest thread takes is what a quiet machine would take, whatever else runs on this one.
void report_threads(const Options& options)
{
    constexpr uint32_t cuts = 4;
    const MapScene scene = make_hall(cuts);
    std::vector<std::unique_ptr<HeadlessCompute>> devices;
    std::vector<Contender> contenders;
    for (const char* threads : { "1", "2" }) {
        setenv("LP_NUM_THREADS", threads, 1);
        devices.push_back(std::make_unique<HeadlessCompute>(HeadlessCompute::Validation::off));
        contenders.emplace_back(*devices.back(), scene, options);
    }
    for (size_t set = 0; set < 3; set++) {
        std::array<std::vector<double>, 2> seconds;
        std::vector<double> ratios;
        for (int round = 0; round < options.rounds; round++) {
            for (size_t i = 0; i < 2; i++)
                seconds[i].push_back(busiest_thread_seconds_of([&] { contenders[i].run(contenders[i].sets()[set]); }));
            ratios.push_back(seconds[0].back() / seconds[1].back());
        }
        std::printf("%-8s CPU of the busiest thread: of one %.1f ms, of two %.1f ms, x%.2f\n",
            contenders[0].sets()[set].set.name, median(seconds[0]) * 1e3, median(seconds[1]) * 1e3, median(ratios));
    }
}

} // namespace
} // namespace vkpt::tests

int main(int argc, char** argv)
{
    vkpt::tests::Options options;
    bool threads = false;
    CLI::App app { "A ray's time against the number of triangles, and against the CPU driver's threads" };
    app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 1000))->capture_default_str();
    app.add_option("--most", options.most, "triangles of the largest hall")->capture_default_str();
    app.add_flag("--threads", threads, "one and two threads of the CPU driver instead");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        threads ? report_threads(options) : report_scaling(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpt_trace_scaling_bench: %s\n", error.what());
        return 1;
    }
    return 0;
}
