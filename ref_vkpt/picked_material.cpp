// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/picked_material.hpp"

#include "ref_vkpt/module.hpp"

#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace vkpt {

namespace {

// Distance to a triangle, both of whose sides are met (Moeller and Trumbore 1997).
std::optional<float> meet_triangle(const shared::Triangle& triangle, glm::vec3 origin, glm::vec3 direction)
{
    const glm::vec3 p = triangle.positions[0], e1 = triangle.positions[1] - p, e2 = triangle.positions[2] - p;
    const glm::vec3 across = glm::cross(direction, e2);
    const float determinant = glm::dot(e1, across);
    if (determinant == 0)
        return std::nullopt;
    const glm::vec3 offset = origin - p, other = glm::cross(offset, e1);
    const float u = glm::dot(offset, across) / determinant, v = glm::dot(direction, other) / determinant,
                t = glm::dot(e2, other) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? std::optional(t) : std::nullopt;
}

// Looks for the nearest surface that has a material.
class Picker {
public:
    explicit Picker(const Module& m)
        : snapshot_(*m.view().snapshot)
        , camera_(*m.last_camera)
        , textures_(m.textures.by_slot())
    {
    }

    void meet(const shared::Triangle& triangle)
    {
        const std::optional<float> t = meet_triangle(triangle, camera_.eye, camera_.forward);
        if (!t || *t >= nearest_)
            return;
        if (const std::optional<PickedMaterial> met = describe(triangle.material)) {
            nearest_ = *t;
            picked_ = met;
        }
    }
    const std::optional<PickedMaterial>& picked() const { return picked_; }

private:
    // Nothing: it has no material that a file could speak of.
    std::optional<PickedMaterial> describe(uint32_t material) const
    {
        const World& world = *snapshot_.world;
        const auto shown = textures_.find(snapshot_.materials[material].texture);
        const bool has_file = shown != textures_.end() && !shown->second->path.empty();
        const Texture* texture = has_file ? shown->second : nullptr;
        if (material < world.material_count()) {
            const uint32_t texinfo = material % uint32_t(world.bsp.texinfos.size());
            return PickedMaterial { world.material_names[texinfo], material, texture, texinfo };
        }
        if (!texture || (texture->use != TextureUse::wall && texture->use != TextureUse::skin))
            return std::nullopt;
        return PickedMaterial { texture->material, material, texture, std::nullopt };
    }

    const SceneSnapshot& snapshot_;
    const shared::Camera& camera_;
    std::map<uint32_t, const Texture*> textures_; // by slot
    float nearest_ = std::numeric_limits<float>::max();
    std::optional<PickedMaterial> picked_;
};

} // namespace

std::optional<PickedMaterial> pick_material(Module& m)
{
    const World* world = m.scene.world();
    if (!world || !m.last_camera || !m.view().snapshot || m.view().snapshot->world != world)
        return std::nullopt;
    Picker picker(m);
    for (const shared::Triangle& triangle : world->models[0].triangles)
        picker.meet(triangle);
    const MovingGeometry& moving = m.view().snapshot->moving;
    std::vector<shared::Triangle> triangles(moving.triangle_count());
    std::vector<uint32_t> masks(triangles.size());
    if (triangles.empty())
        return picker.picked();
    MovingTarget target;
    target.triangles = triangles.data();
    target.masks = masks.data();
    MovingWriter(m.workers).write(moving, target);
    for (size_t i = 0; i < triangles.size(); i++)
        if (!(masks[i] & (shared::MASK_VIEW_WEAPON | shared::MASK_OWN_BODY)))
            picker.meet(triangles[i]);
    return picker.picked();
}

} // namespace vkpt
