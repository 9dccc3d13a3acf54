#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Install, build with sanitizers, test: scripts/sanitize.sh address|thread [arguments of ctest]
#   address  AddressSanitizer, LeakSanitizer and UBSan; without arguments the suite that scripts/test.sh runs
#   thread   ThreadSanitizer on the cases that work with several threads (named below); GTEST_FILTER chooses others
# The exit code is not 0 where a test fails or a sanitizer finds something. Findings that a test has not printed are in
# build/asan/findings or build/tsan/findings.
set -euo pipefail
cd "$(dirname "$0")/.."

# What starts threads: rendering, separating and acquiring, the live view, and the tests of what threads share. Each
# scene is rendered by every kernel and written by the program; what renders it again to measure radiances is left out.
threaded=(
  'TextureCache.*' 'TevView.*' 'WriteAtomically.*'                                       # unit_core
  'Separate.*' 'WavelengthBlocks.*' 'Split.*' 'Acquired/OwnMaterial.*'                   # unit_separation
  'PartialRenders.*' 'BuildScene.*'                                                      # unit_renderer
  'Zoo/EveryScene.ThreadsChangeNoBit/*' 'Zoo/EveryScene.KernelsChangeNoBit/*' 'Zoo/EverySceneAov.ChangesNoBit*'
  'Zoo/EverySceneMatte.ThreadsAndOther*' 'Textures.*' 'SpectralImages.*' 'Mattes.*'      # render
  'Scenes/EveryScene.*Threads/*' 'Scenes/MeasuredScene.*' 'Render.*' 'LongRender.*' 'LiveView.*' 'ProgressOption.*'
  'QualityKey.*' 'Reproduce.*'                                                           # cli
)

kind="${1:-}"
(($# > 0)) && shift
case "$kind" in
  address) preset=asan targets=(all) selection=(-LE 'long|slurm|denoise') packages=() ;;
  thread)
    preset=tsan targets=(spectrace unit_core unit_separation unit_renderer render cli) packages=(dpkg-dev)
    selection=(-R '^(unit_core|unit_separation|unit_renderer|render|cli_.*)$')
    export GTEST_FILTER="${GTEST_FILTER:-$(IFS=:; echo "${threaded[*]}")}"
    ;;
  *) sed -n '3,5s/^# //p' "$0" >&2; exit 2 ;;
esac
(($# == 0)) || selection=("$@")
build="$PWD/build/$preset"

# ThreadSanitizer sees only what it was compiled into. Debian's oneTBB is not: each task that one thread hands to
# another would be a race. So its source package is compiled too, and used instead. apt gets directories of its own, so
# that the system's sources stay as they are. -Wno-tsan: fences alone say nothing to ThreadSanitizer, and oneTBB hands
# tasks over by atomic variables besides.
build_tbb() {
  local work="$build/onetbb"
  [[ -e "$work/install/lib/cmake/TBB/TBBConfig.cmake" ]] && return
  rm -rf "$work"
  mkdir -p "$work"/{lists/partial,cache,sources}
  . /etc/os-release
  cat >"$work/sources/onetbb.sources" <<END
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: $VERSION_CODENAME
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
  cat >"$work/apt.conf" <<END
Dir::State::lists "$work/lists";
Dir::Cache "$work/cache";
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$work/sources";
APT::Sandbox::User "$(id -un)";
END
  (cd "$work" && export APT_CONFIG="$work/apt.conf" && apt-get -qq update && apt-get -qq source --only-source onetbb)
  local source=("$work"/onetbb-*/)
  cmake -S "${source[0]}" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS=-Wno-tsan \
    -DCMAKE_INSTALL_PREFIX="$work/install" -DCMAKE_INSTALL_LIBDIR=lib \
    -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF >/dev/null
  cmake --build "$work/build"
  cmake --install "$work/build" >/dev/null
}

scripts/install_packages.sh "${packages[@]}"
export SPECTRACE_DATA="${SPECTRACE_DATA:-$PWD/../shared/data}"
options=(-DSPECTRACE_BUILD_TESTS=ON)
if [[ "$kind" == thread ]]; then
  build_tbb
  options+=(-DTBB_DIR="$build/onetbb/install/lib/cmake/TBB")
fi
cmake --preset "$preset" "${options[@]}" >/dev/null
cmake --build --preset "$preset" --target "${targets[@]}"

# An exit code that the program does not have: no test takes a finding for the failure it waits for. What the program
# reports under a test that reads its output goes to a file (UBSan knows no file; it ends the program there).
findings="$build/findings"
rm -rf "$findings"
mkdir -p "$findings"
common="exitcode=99:log_path=$findings/report"
export ASAN_OPTIONS="$common:detect_leaks=1:detect_stack_use_after_return=1:strict_string_checks=1"
export LSAN_OPTIONS="exitcode=99"
export UBSAN_OPTIONS="exitcode=99:halt_on_error=1:print_stacktrace=1"
export TSAN_OPTIONS="$common:second_deadlock_stack=1:history_size=4"

code=0
ctest --test-dir "$build" --output-on-failure -j "$(nproc)" "${selection[@]}" || code=$?
if [[ -n "$(ls -A "$findings")" ]]; then
  echo "sanitize.sh: findings in $findings:" >&2
  grep -hE '^(SUMMARY|WARNING|==[0-9]+==ERROR)' "$findings"/* | sort | uniq -c | sort -rn | head -20 >&2
  code=1
fi
exit "$code"
