#!/bin/bash -eu
# SPDX-License-Identifier: GPL-2.0-or-later
# Builds the harnesses in OSS-Fuzz's way: compiler, flags, engine and folders come by the environment (CC, CXX, CFLAGS,
# CXXFLAGS, LIB_FUZZING_ENGINE, SRC, WORK, OUT). Without them, where clang is installed, it makes libFuzzer's programs under the address sanitizer in
# build/oss-fuzz/out, so that it can be tried by hand.
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
: "${CC:=clang}" "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
: "${WORK:=$root/build/oss-fuzz/work}" "${OUT:=$root/build/oss-fuzz/out}"
: "${CFLAGS:=-O1 -gline-tables-only -fsanitize=fuzzer-no-link,address}" "${CXXFLAGS:=$CFLAGS}"
export CC CXX LIB_FUZZING_ENGINE
mkdir -p "$WORK" "$OUT"

# Debian's headers go with its own C++ library; the image that runs the programs has no libraries of ours: all are linked in.
CXXFLAGS=${CXXFLAGS//-stdlib=libc++/}
find_static() { "$CC" -print-file-name="lib$1.a"; }
cmake -S "$root" -B "$WORK/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS="$CFLAGS" -DCMAKE_CXX_FLAGS="$CXXFLAGS" \
    -DCMAKE_EXE_LINKER_FLAGS="-static-libstdc++ -static-libgcc" \
    -DVKPT_FMT=fmt::fmt-header-only -DPNG_LIBRARY="$(find_static png)" -DZLIB_LIBRARY="$(find_static z)" -DJPEG_LIBRARY="$(find_static jpeg)" \
    -DVKPT_READERS_ONLY=ON -DVKPT_FUZZ=ON -DBUILD_TESTING=OFF
cmake --build "$WORK/build" --target harness_programs fuzz_seeds

while read -r name; do
    cp "$WORK/build/fuzz/${name}_fuzzer" "$OUT/"
    [[ ! -e $root/fuzz/dictionaries/$name.dict ]] || cp "$root/fuzz/dictionaries/$name.dict" "$OUT/${name}_fuzzer.dict"
    rm -rf "$WORK/corpus" "$OUT/${name}_fuzzer_seed_corpus.zip"
    mkdir "$WORK/corpus"
    for folder in "$WORK/build/fuzz/seeds/$name" "$root/fuzz/corpus/$name" "$root/fuzz/findings/$name"; do
        [[ ! -d $folder ]] || cp -r "$folder/." "$WORK/corpus/"
    done
    (cd "$WORK/corpus" && python3 -m zipfile -c "$OUT/${name}_fuzzer_seed_corpus.zip" .)
done <"$WORK/build/fuzz/harnesses.txt"
