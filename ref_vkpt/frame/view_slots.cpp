// SPDX-License-Identifier: GPL-2.0-or-later
// Views that are drawn in turn, so that settings can be compared side by side: each finds its pixels' history again.
#include "ref_vkpt/module.hpp"

#include <utility>

namespace vkpt {

// Of the world's views, and of menus.
Buffer Frame::make_exposure()
{
    return graphics_.uploader.make_buffer(std::vector<shared::ExposureState>(2), MemoryKind::images, "exposure");
}

void Frame::exchange_view(ParkedView& parked)
{
    graphics_.screen.exchange(parked.buffers);
    std::swap(exposure_, parked.exposure);
    std::swap(state_, parked.state);
    is_followed_by_another_ = true;
}

// A view that is drawn for the first time.
void Frame::prepare_view()
{
    if (exposure_)
        return;
    exposure_ = make_exposure();
    graphics_.uploader.flush();
}

namespace {

void exchange(Module& module, Module::ParkedScene& parked)
{
    module.frame.exchange_view(parked.view);
    std::swap(module.snapshot, parked.snapshot);
    std::swap(module.snapshot_is_frozen, parked.snapshot_is_frozen);
}

// The map's lists go on with the other view's lights, and those of `snapshot` would be looked up in vain.
void keep_lights(SceneSnapshot& snapshot)
{
    if (!snapshot.world || !snapshot.kept_lights.lists.empty())
        return;
    const LightLists& lights = snapshot.world->light_lists;
    snapshot.kept_lights = { lights.lists(), lights.dynamic_indices() };
}

} // namespace

void select_view(Module& module, uint32_t view)
{
    if (view == module.selected_view)
        return;
    if (module.snapshot)
        keep_lights(*module.snapshot);
    exchange(module, module.parked_views[module.selected_view]);
    exchange(module, module.parked_views[view]);
    module.selected_view = view;
    module.frame.prepare_view();
}

} // namespace vkpt
