# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root, build_dir: see common.sh
# Configuring and building the preset `release`.

has_tests() { grep -qE '^BUILD_TESTING:[A-Z]+=(ON|1|TRUE)$' "$build_dir/CMakeCache.txt"; }

# build_targets TARGET...: configures where that was never done, builds what changed, is silent where nothing did.
build_targets() {
    if [[ -e $build_dir && ! -w $build_dir ]]; then
        die "$build_dir belongs to $(stat -c %U "$build_dir") (an earlier run as another user). Remove it: sudo rm -r $build_dir"
    fi
    # Where only the game was set up, or the tests' packages have been removed, what the tests are built with is not there.
    local tests=ON
    [[ $1 == all || -e /usr/include/gtest/gtest.h ]] || tests=OFF
    if [[ ! -e $build_dir/build.ninja ]] || { [[ $1 == all ]] && ! has_tests; } || { [[ $tests == OFF ]] && has_tests; }; then
        run_step configure "Configuring (cmake --preset release)" \
            cmake --preset release -D BUILD_TESTING=$tests -S "$root" -B "$build_dir" || die "cmake failed"
    fi
    run_step build "Building ref_vkpt and its game data (the first time takes minutes)" \
        cmake --build "$build_dir" --parallel "$(nproc)" --target "$@" || die "the build failed"
}
