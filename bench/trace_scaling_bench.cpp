// SPDX-License-Identifier: GPL-2.0-or-later
// How a ray's time grows with the triangles of a map, traced by the software backend's traversal in a shader of its own
// and by Embree: of a hall whose walls and pillars are cut into ever more triangles with displaced corners, and of a
// map of ever more rooms with doors. And how much faster two threads of the CPU driver are than one.
#include "bench/embree_scene.hpp"
#include "bench/ray_sets.hpp"
#include "tests/rays/gpu_tracer.hpp"

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
    bool rooms = false, texels = false;
};

// A pseudo-random displacement that depends on the place alone, so that neighbouring faces stay joined.
float bump(glm::vec3 p)
{
    return 1.5f * (std::sin(p.x * 0.37f + p.y * 0.11f) + std::sin(p.y * 0.29f + p.z * 0.23f) + std::sin(p.z * 0.41f));
}

class FaceMaker {
public:
    FaceMaker(uint32_t cuts, bool bumpy)
        : cuts_(cuts)
        , bumpy_(bumpy)
    {
    }

    // cuts x cuts squares of two triangles; the front is on the side of cross(u, v).
    void add_face(glm::vec3 corner, glm::vec3 u, glm::vec3 v)
    {
        const glm::vec3 normal = glm::normalize(glm::cross(u, v));
        const auto point = [&](uint32_t i, uint32_t j) {
            const glm::vec3 flat = corner + u * (float(i) / float(cuts_)) + v * (float(j) / float(cuts_));
            return bumpy_ ? flat + normal * bump(flat) : flat;
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
    bool bumpy_;
};

// 262 faces of 2 cuts^2 triangles.
MapScene make_hall(int cuts)
{
    constexpr float size = 2048, height = 384;
    constexpr int pillars = 8; // along each side
    FaceMaker hall(uint32_t(cuts), true);
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

// rooms x rooms of them with four pillars each, some 1,000 triangles, a door in each wall between two. The eye is in
// the middle one, lights are the ceilings of that and of its neighbours.
MapScene make_rooms(int rooms)
{
    constexpr float size = 512, height = 224, wall = 16, door = 96, door_height = 128;
    FaceMaker map(5, false);
    MapScene scene;
    // A wall around its door, as `across` and `up` see it from inside the room, and half of the way through the door.
    const auto add_wall = [&](glm::vec3 corner, glm::vec3 across, bool has_door) {
        const glm::vec3 up(0, 0, 1), out = glm::cross(across, up);
        const auto panel = [&](float from, float to, float low, float high) {
            map.add_face(corner + across * from + up * low, up * (high - low), across * (to - from));
        };
        if (!has_door) {
            panel(0, size, 0, height);
            return;
        }
        const float left = (size - door) / 2, right = left + door;
        panel(0, left, 0, height);
        panel(right, size, 0, height);
        panel(left, right, door_height, height);
        const glm::vec3 at_left = corner + across * left, at_right = corner + across * right, depth = out * (wall / 2);
        map.add_face(at_left, depth, up * door_height);
        map.add_face(at_right, up * door_height, depth);
        map.add_face(at_left, across * door, depth);
        map.add_face(at_left + up * door_height, depth, across * door);
    };
    for (int y = 0; y < rooms; y++)
        for (int x = 0; x < rooms; x++) {
            const glm::vec3 low = glm::vec3(x, y, 0) * (size + wall);
            add_wall(low, { 1, 0, 0 }, y > 0);
            add_wall(low + glm::vec3(size, 0, 0), { 0, 1, 0 }, x + 1 < rooms);
            add_wall(low + glm::vec3(size, size, 0), { -1, 0, 0 }, y + 1 < rooms);
            add_wall(low + glm::vec3(0, size, 0), { 0, -1, 0 }, x > 0);
            map.add_face(low, { size, 0, 0 }, { 0, size, 0 });
            const size_t ceiling = map.triangles.size();
            map.add_face(low + glm::vec3(0, 0, height), { 0, size, 0 }, { size, 0, 0 });
            if (std::abs(x - rooms / 2) + std::abs(y - rooms / 2) <= 1)
                for (size_t i = ceiling; i < map.triangles.size(); i++)
                    scene.lights.push_back(uint32_t(i));
            for (int i = 0; i < 4; i++) {
                const glm::vec3 at = low + glm::vec3(float(i % 2) * 256 + 128, float(i / 2) * 256 + 128, 0);
                map.add_walls(at - glm::vec3(24, 24, 0), at + glm::vec3(24, 24, height), false);
            }
        }
    scene.triangles = std::move(map.triangles);
    scene.eye = glm::vec3(float(rooms / 2), float(rooms / 2), 0) * (size + wall) + glm::vec3(60, 80, 56);
    scene.yaw = 40;
    return scene;
}

struct Traced {
    RaySet set;
    std::unique_ptr<GpuTracer> tracer;
};

// One scene on one device, ready to be traced.
class Contender {
public:
    Contender(HeadlessCompute& device, const MapScene& scene, const Options& options)
        : pipelines_(create_trace_pipelines(device, options.texels))
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
    TracePipelines pipelines_;
    Bvh tree_;
    std::vector<Traced> sets_;
};

// Somebody who traces the rays of a scene, and what that took: seconds for a ray of each set, round by round.
struct Row {
    const char* who;
    size_t triangles;
    const Contender* scene; // whose rays
    std::function<void(const Traced&)> trace;
    std::array<std::vector<double>, 3> seconds;

    void run()
    {
        for (size_t set = 0; set < seconds.size(); set++) {
            const Traced& traced = scene->sets()[set];
            seconds[set].push_back(cpu_seconds_of([&] { trace(traced); }) / double(traced.set.rays.size()));
        }
    }
};

void show_row(const Row& row, const Row& first)
{
    std::printf("%8zu triangles  %-6s", row.triangles, row.who);
    for (size_t set = 0; set < row.seconds.size(); set++) {
        std::vector<double> ratios;
        for (size_t round = 0; round < row.seconds[set].size(); round++)
            ratios.push_back(row.seconds[set][round] / first.seconds[set][round]);
        std::printf("  %6.1f x%.2f", find_median(row.seconds[set]) * 1e9, find_median(ratios));
    }
    std::printf("\n");
}

void report_scaling(const Options& options)
{
    const auto make = options.rooms ? make_rooms : make_hall;
    const auto sizes = options.rooms ? std::array { 1, 2, 5, 10, 22, 32 } : std::array { 1, 3, 9, 14, 31, 44 };
    HeadlessCompute device(HeadlessCompute::Validation::off);
    std::printf("device: %s\nns of CPU time for a primary, bounce and shadow ray, then relative to the first row\n",
        device.device_name().c_str());
    std::vector<std::unique_ptr<Contender>> scenes;
    std::vector<Row> ours, embrees;
    for (const int size : sizes) {
        const MapScene scene = make(size);
        if (scene.triangles.size() > options.most * 5ull / 4)
            break;
        const Contender* rays = scenes.emplace_back(std::make_unique<Contender>(device, scene, options)).get();
        ours.push_back(
            { "ours", scene.triangles.size(), rays, [rays](const Traced& traced) { rays->run(traced); }, {} });
#ifdef VKPT_HAVE_EMBREE
        const auto embree = std::make_shared<EmbreeScene>(scene.triangles);
        embrees.push_back({ "Embree", scene.triangles.size(), rays,
            [embree](const Traced& traced) { embree->trace(traced.set.rays, traced.set.any_hit); }, {} });
#endif
    }
    for (int round = 0; round < options.rounds; round++)
        for (std::vector<Row>* rows : { &ours, &embrees })
            for (Row& row : *rows)
                row.run();
    for (const std::vector<Row>* rows : { &ours, &embrees })
        for (const Row& row : *rows)
            show_row(row, rows->front());
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
    constexpr int cuts = 4;
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
            contenders[0].sets()[set].set.name, find_median(seconds[0]) * 1e3, find_median(seconds[1]) * 1e3,
            find_median(ratios));
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
    app.add_option("--most", options.most, "triangles of the largest scene")->capture_default_str();
    app.add_flag("--rooms", options.rooms, "a map of more and more rooms instead of a hall cut finer and finer");
    app.add_flag("--texels", options.texels, "nodes and triangles read as texels instead of by address");
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
