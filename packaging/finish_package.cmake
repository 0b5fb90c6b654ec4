# SPDX-License-Identifier: GPL-2.0-or-later
# Run by CPack over what is to be packed.
function(run)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${CPACK_TEMPORARY_DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
# Debian wants manual pages and the changelog compressed.
run(find . -path "*/share/man/*" -type f -not -name "*.gz" -exec gzip -9n {} +)
run(find . -path "*/share/doc/*" -name changelog -exec gzip -9n {} +)
# Whatever the builder's umask is; libraries that are opened by their path need no right to be run.
run(chmod -R go-w,a+rX .)
run(find . -path "*/lib/vkpt/*.so" -exec chmod 644 {} +)
