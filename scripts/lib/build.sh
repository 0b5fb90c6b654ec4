# SPDX-License-Identifier: GPL-2.0-or-later
# shellcheck shell=bash
# shellcheck disable=SC2154  # root, build_dir: see common.sh
# Configuring and building the preset `release`.

# build_targets TARGET...: configures where that was never done, builds what changed, is silent where nothing did.
build_targets() {
    if [[ -e $build_dir && ! -w $build_dir ]]; then
        die "$build_dir belongs to $(stat -c %U "$build_dir") (an earlier run as another user). Remove it: sudo rm -r $build_dir"
    fi
    if [[ ! -e $build_dir/build.ninja ]]; then
        run_step configure "Configuring (cmake --preset release)" cmake --preset release -S "$root" -B "$build_dir" || die "cmake failed"
    fi
    run_step build "Building ref_vkpt and its game data (the first time takes minutes)" \
        cmake --build "$build_dir" --parallel "$(nproc)" --target "$@" || die "the build failed"
}
