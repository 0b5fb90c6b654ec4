// SPDX-License-Identifier: GPL-2.0-or-later
// Handles of the device: who destroys them, and when.
#include "ref_vkpt/vulkan/handle.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace vkpt::tests {
namespace {

const auto device = VkDevice(uintptr_t { 1 });
VkFence fence(uintptr_t number) { return VkFence(number); }

std::vector<VkFence> destroyed;
void note_destroyed(VkDevice of, VkFence fence, const VkAllocationCallbacks*)
{
    EXPECT_EQ(of, device);
    destroyed.push_back(fence);
}
auto* destroy = note_destroyed; // as the entry points are: found at run time
using TestHandle = Handle<VkFence, destroy>;

class HandleTest : public testing::Test {
protected:
    HandleTest() { destroyed.clear(); }
};

TEST_F(HandleTest, IsDestroyedOnceByItsLastOwner)
{
    {
        TestHandle first(device, fence(7));
        TestHandle second(std::move(first));
        EXPECT_EQ(VkFence(second), fence(7));
        EXPECT_EQ(VkFence(first), VkFence(VK_NULL_HANDLE));
        TestHandle third;
        third = std::move(second);
        EXPECT_EQ(VkFence(third), fence(7));
        EXPECT_TRUE(destroyed.empty());
    }
    EXPECT_EQ(destroyed, std::vector { fence(7) });
}

TEST_F(HandleTest, AMoveEmptiesItsSourceAndDestroysWhatTheTargetHad)
{
    TestHandle first(device, fence(1)), second(device, fence(2));
    first = std::move(second);
    EXPECT_EQ(destroyed, std::vector { fence(1) });
    EXPECT_EQ(VkFence(first), fence(2));
    EXPECT_EQ(VkFence(second), VkFence(VK_NULL_HANDLE));
}

TEST_F(HandleTest, IsDestroyedBeforeItIsMadeAnew)
{
    TestHandle handle(device, fence(1));
    const auto create = [](VkDevice, const VkFenceCreateInfo*, const VkAllocationCallbacks*, VkFence* made) {
        EXPECT_EQ(destroyed, std::vector { fence(1) });
        *made = fence(2);
        return VK_SUCCESS;
    };
    EXPECT_EQ(handle.renew(create, device, VkFenceCreateInfo {}), VK_SUCCESS);
    EXPECT_EQ(VkFence(handle), fence(2));
}

// What a call that fails writes is nothing to be destroyed.
TEST_F(HandleTest, TakesNothingFromACallThatFails)
{
    {
        TestHandle handle;
        const auto create = [](VkDevice, const VkFenceCreateInfo*, const VkAllocationCallbacks*, VkFence* made) {
            *made = fence(3);
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        };
        EXPECT_EQ(handle.renew(create, device, VkFenceCreateInfo {}), VK_ERROR_OUT_OF_HOST_MEMORY);
        EXPECT_EQ(VkFence(handle), VkFence(VK_NULL_HANDLE));
    }
    EXPECT_TRUE(destroyed.empty());
}

} // namespace
} // namespace vkpt::tests
