#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# tools/soak.sh [--minutes N] [--kills N] [--size N] [--seed S]
# Tests that take too long for ./test, for a night: a server under load for an hour (--minutes) with the sanitized fuzz targets in turns,
# 1,000 kills of programs that write (--kills), and ten times as many hostile files (--size). Prints a summary of each and goes on
# after a failure; the exit code is 1 where one failed, and inputs on which fuzz targets failed are in build/fuzz-failures.
set -u -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/tools/setup.sh"

minutes=60 kills=1000 size=10 seed=$(date +%j)
while [ $# -gt 0 ]; do
    case $1 in
        --minutes) minutes=${2-} ;;
        --kills) kills=${2-} ;;
        --size) size=${2-} ;;
        --seed) seed=${2-} ;;
        *) fail "what is $1?" "tools/soak.sh [--minutes N] [--kills N] [--size N] [--seed S]" ;;
    esac
    [ $# -gt 1 ] || fail "$1 needs a number."
    shift 2
done

install_packages build run test
configure_program release with-tests
build_program release embody embody-import-worker
configure_program fuzz with-tests
build_program fuzz fuzzers

embody=$root/build/release/src/embody
failed=""
stage() {
    local name=$1
    shift
    say "== $name (seed $seed) =="
    "$@" --seed "$seed" || failed="$failed $name"
}
stage soak python3 "$root/tests/attacks/soak.py" "$embody" "$root/build/fuzz/tests/fuzz" --minutes "$minutes" --keep "$root/build/fuzz-failures"
stage kills python3 "$root/tests/attacks/kills.py" "$embody" --kills "$kills"
stage attacks python3 "$root/tests/attacks/attacks.py" "$embody" --size "$size"

[ -z "$failed" ] || fail "failed:$failed"
say "Nothing failed."
