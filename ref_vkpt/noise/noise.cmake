# SPDX-License-Identifier: GPL-2.0-or-later
# The blue-noise masks as data: a static library of its own, so that tests read the very same.
set(blue_noise_source ${CMAKE_BINARY_DIR}/generated/blue_noise_words.cpp)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/generated)
add_custom_command(
    OUTPUT ${blue_noise_source}
    COMMAND vkpt_blue_noise -o ${blue_noise_source}
    DEPENDS vkpt_blue_noise
    COMMENT "Blue-noise masks"
    VERBATIM)
add_library(vkpt_blue_noise_masks STATIC ${blue_noise_source})
target_link_libraries(vkpt_blue_noise_masks PRIVATE vkpt_build)
