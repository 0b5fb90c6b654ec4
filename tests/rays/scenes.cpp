// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/scenes.hpp"

#include "formats/bsp.hpp"
#include "formats/entities.hpp"

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>

namespace vkpt::tests {

float uniform(Random& random, float low, float high)
{
    return std::uniform_real_distribution<float>(low, high)(random);
}

glm::vec3 random_direction(Random& random)
{
    for (;;) {
        glm::vec3 d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        float length = glm::length(d);
        if (length > 0.01f && length < 1.0f)
            return d / length;
    }
}

static glm::vec3 random_point(Random& random, float half)
{
    return { uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half) };
}

std::vector<BvhTriangle> random_triangles(Random& random, size_t count, float size, uint32_t first_id)
{
    std::vector<BvhTriangle> triangles(count);
    for (BvhTriangle& triangle : triangles) {
        triangle.positions[0] = random_point(random, 2048.0f);
        triangle.positions[1] = triangle.positions[0] + random_direction(random) * uniform(random, 0.1f, 1.0f) * size;
        triangle.positions[2] = triangle.positions[0] + random_direction(random) * uniform(random, 0.1f, 1.0f) * size;
        triangle.id = first_id++;
        triangle.mask = 0xff;
    }
    return triangles;
}

std::vector<BvhTriangle> room(float half, int cells, uint32_t first_id)
{
    std::vector<BvhTriangle> triangles;
    auto corner = [&](int axis, float side, int i, int j) {
        glm::vec3 p;
        p[axis] = side * half;
        p[(axis + 1) % 3] = half * (2.0f * float(i) / float(cells) - 1.0f);
        p[(axis + 2) % 3] = half * (2.0f * float(j) / float(cells) - 1.0f);
        return p;
    };
    for (int axis = 0; axis < 3; axis++)
        for (float side : { -1.0f, 1.0f })
            for (int i = 0; i < cells; i++)
                for (int j = 0; j < cells; j++) {
                    glm::vec3 a = corner(axis, side, i, j), b = corner(axis, side, i + 1, j);
                    glm::vec3 c = corner(axis, side, i + 1, j + 1), d = corner(axis, side, i, j + 1);
                    triangles.push_back({ { a, b, c }, first_id++, 0xff });
                    triangles.push_back({ { a, c, d }, first_id++, 0xff });
                }
    return triangles;
}

std::vector<shared::TestRay> random_rays(Random& random, size_t count, float half)
{
    std::vector<shared::TestRay> rays(count);
    for (size_t i = 0; i < count; i++) {
        glm::vec3 from = random_point(random, half), to = random_point(random, half);
        float length = glm::length(to - from);
        glm::vec3 direction = (to - from) / length;
        if (i % 10 == 0) {
            direction = glm::vec3(0.0f);
            direction[int(i / 10 % 3)] = i / 30 % 2 ? 1.0f : -1.0f;
        }
        rays[i] = { from, 0.0f, direction, i % 2 ? length : 1e30f };
    }
    return rays;
}

static void find_player_start(const formats::Bsp& bsp, MapScene& scene)
{
    constexpr float eye_height = 22.0f;
    for (const formats::EntityText& entity : formats::parse_entities(bsp.entity_text, bsp.name))
        if (entity.class_name().starts_with("info_player_")) {
            scene.eye = entity.vector("origin").value_or(glm::vec3(0)) + glm::vec3(0, 0, eye_height);
            scene.yaw = entity.number("angle", 0.0f);
            return;
        }
}

MapScene load_map(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::vector<char> content { std::istreambuf_iterator<char>(file), {} };
    formats::Bsp bsp = formats::read_bsp(std::as_bytes(std::span(content)), path.filename().string());
    MapScene scene;
    int first = bsp.models[0].first_face;
    for (int face = first; face < first + bsp.models[0].face_count; face++) {
        uint32_t flags = bsp.texinfos[bsp.faces[size_t(face)].texinfo].flags;
        if (flags & (formats::SURF_SKY | formats::SURF_NODRAW))
            continue;
        std::vector<glm::vec3> polygon = bsp.face_polygon(size_t(face));
        for (size_t i = 2; i < polygon.size(); i++) {
            uint32_t index = uint32_t(scene.triangles.size());
            scene.triangles.push_back({ { polygon[0], polygon[i - 1], polygon[i] }, index, 0xff });
            if (flags & formats::SURF_LIGHT)
                scene.lights.push_back(index);
        }
    }
    find_player_start(bsp, scene);
    return scene;
}

} // namespace vkpt::tests
