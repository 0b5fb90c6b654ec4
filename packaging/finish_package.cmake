# SPDX-License-Identifier: GPL-2.0-or-later
# Run by CPack over what is to be packed: manual pages and the changelog are compressed, as Debian wants them.
file(GLOB_RECURSE pages ${CPACK_TEMPORARY_DIRECTORY}/*/share/man/*.[1-9] ${CPACK_TEMPORARY_DIRECTORY}/*/share/doc/*/changelog)
foreach(page IN LISTS pages)
    execute_process(COMMAND gzip -9nf ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
# The linker's runtime path of the build has no place in a package; folders of CPack's may be writable for a group.
execute_process(COMMAND chmod -R go-w,a+rX ${CPACK_TEMPORARY_DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE libraries ${CPACK_TEMPORARY_DIRECTORY}/*/lib/vkpt/*.so)
foreach(library IN LISTS libraries)
    execute_process(COMMAND chmod 644 ${library} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
