#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Follows the README on an empty machine: a new minimal Debian 12 (debootstrap) with a clone of the last commit.
#
#   tools/fresh_machine.sh [all]        run and test, each on a machine of its own
#   tools/fresh_machine.sh run          ./run --help, then ./run serve until its address answers
#   tools/fresh_machine.sh test         ./test
#   tools/fresh_machine.sh configure    the packages of ./run, its configuration, and a dry run of its build
#
#   --below DIR     parent of the folder for the machines (default: ${TMPDIR:-/tmp}); some 3 GB
#   --keep          does not remove that folder
#   --limit HOURS   ends a command that takes longer, and fails (default: 6)
#
# It needs root, debootstrap, git and a network; it uses this machine's sources and settings of apt, name servers, proxies and
# certificates. Logs: build/fresh-machine/. Exit status: 0 success, 1 a step failed, 2 wrong use, 77 a requirement is missing.
set -u -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/tools/setup.sh"

readonly suite=bookworm exit_usage=2 exit_unable=77
logs="$root/build/fresh-machine"
# Downloads that are kept; apt and debootstrap check them against the mirror's signed lists each time.
packages="$logs/packages"
below="${TMPDIR:-/tmp}" folder="" keep=no limit_hours=6 job=""

unable() {
    say "fresh_machine: $1"
    say "               $2"
    exit $exit_unable
}

usage() {
    sed -n '3,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
    exit "$1"
}

# The Debian mirror of this machine's own sources.
find_mirror() {
    apt-get indextargets --format '$(REPO_URI)' "Created-By: Packages" "Release: $suite" "Component: main" 2>/dev/null | head -n 1
}

check_machine() {
    [ "$(id -u)" -eq 0 ] || unable "making a machine needs root (chroot, mount)." "Run it as root or with sudo."
    command -v debootstrap >/dev/null || unable "debootstrap is not here." "Install it: apt-get install debootstrap"
    git -C "$root" rev-parse --verify --quiet HEAD >/dev/null || unable "$root is no git clone, or git is not here." "Only what is committed is tried."
    unshare --mount --pid --fork true 2>/dev/null || unable "this machine may not mount (unshare failed)." "In a container, start that with the right to."
    mirror=$(find_mirror)
    mirror=${mirror%/}
    [ -n "$mirror" ] || unable "apt has no source of Debian 12 ($suite)." "Add one to /etc/apt/sources.list.d, or run it on Debian 12."
    /usr/lib/apt/apt-helper -o Acquire::Retries=0 download-file "$mirror/dists/$suite/InRelease" "$folder/InRelease" >"$logs/network.log" 2>&1 ||
        unable "$mirror cannot be reached." "Is there a network? Log: build/fresh-machine/network.log"
}

# Ends all that still runs. Every mount is made in the mount namespace of a command and ends with it; --one-file-system
# is a second guard.
clean_up() {
    [ -z "$job" ] || { kill -KILL -- "-$job" && finish; } 2>/dev/null
    [ -z "$folder" ] || [ $keep = yes ] || rm -rf --one-file-system "$folder"
}

# start LOG COMMAND…: in the background and in a process group of its own, so that an interrupt takes effect at once and
# ends all of it.
start() {
    set -m
    timeout --foreground --signal=KILL "${limit_hours}h" unshare --mount --pid --fork --kill-child "${@:2}" >"$1" 2>&1 </dev/null &
    job=$!
    set +m
}

# finish: waits for the process of start.
finish() {
    local status
    wait "$job"
    status=$?
    job=""
    return $status
}

# start_on MACHINE LOG COMMAND…: the command in the clone on the machine, with nothing of this machine's environment but
# proxies.
start_on() {
    local machine=$1 log=$2 proxies
    mapfile -t proxies < <(env | grep -iE '^(https?|no|all)_proxy=')
    start "$log" --mount-proc --root="$machine" --wd=/root/embody env -i "${proxies[@]}" HOME=/root \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 bash -c \
        'mount -t sysfs -o ro sysfs /sys && mount -t devpts devpts /dev/pts && mount -t tmpfs -o mode=1777 tmpfs /dev/shm && exec "$@"' \
        bash "${@:3}"
}

# step_failed STEP LOG [WHY]: prints the end of its log, and the path of all of it.
step_failed() {
    tail -n 30 "$2" >&2
    fail "fresh machine: $1 failed${3:+: $3}." "Log: ${2#"$root"/}"
}

# A minimal installation, with this machine's network configuration.
make_base() {
    local base="$folder/base"
    say "A minimal Debian 12 from $mirror …"
    # Nothing of the machine needs to outlive a crash, and waiting for the disk after each package takes longer than all
    # else.
    mkdir -p "$base/etc/dpkg/dpkg.cfg.d"
    echo force-unsafe-io >"$base/etc/dpkg/dpkg.cfg.d/throw-away"
    start "$logs/debootstrap.log" debootstrap --variant=minbase --cache-dir="$packages" "$suite" "$base" "$mirror"
    finish || step_failed debootstrap "$logs/debootstrap.log"
    rm -f "$base/etc/apt/sources.list"
    mkdir -p "$base/usr/local/share/ca-certificates" "$base/var/cache/packages/partial"
    # Packages are kept in a folder of their own, because apt's settings for containers empty the usual one.
    if ! { cp -a /etc/apt/. "$base/etc/apt/" && cp -a /usr/share/keyrings/. "$base/usr/share/keyrings/" &&
        cp -L /etc/resolv.conf /etc/hosts "$base/etc/" &&
        { [ ! -d /usr/local/share/ca-certificates ] || cp -rL /usr/local/share/ca-certificates/. "$base/usr/local/share/ca-certificates/"; } &&
        echo 'Dir::Cache::archives "/var/cache/packages";' >"$base/etc/apt/apt.conf.d/zz-packages" &&
        cp "$packages"/*.deb "$base/var/cache/packages/" &&
        git clone --quiet --no-hardlinks "$root" "$base/root/embody"; }; then
        fail "fresh machine: this machine's settings or the clone could not be copied to $base."
    fi
}

# new_machine NAME: a copy of the base on which no command has run; sets `machine`.
new_machine() {
    machine="$folder/$1"
    cp -a "$folder/base" "$machine" || fail "fresh machine: copying the minimal system failed; is the disk full?"
}

# on_machine STEP COMMAND…: runs the command; shows its log where it fails.
on_machine() {
    local log="$logs/$1.log" began=$SECONDS status
    say "$1 … (log: build/fresh-machine/$1.log)"
    start_on "$machine" "$log" "${@:2}"
    finish
    status=$?
    if [ $status -ne 0 ]; then
        keep_build_logs "$1"
        step_failed "$1" "$log" "exit status $status after $((SECONDS - began)) s"
    fi
    say "$1: done after $((SECONDS - began)) s"
}

# keep_build_logs STEP: copies the logs of apt, CMake, Ninja and npm from a machine that failed, before it is removed.
keep_build_logs() {
    local log
    for log in "$machine"/root/embody/build/*.log; do [ ! -f "$log" ] || cp "$log" "$logs/$1.$(basename "$log")"; done
}

# answers ADDRESS: whether http://HOST:PORT/ gives the Studio's page.
answers() {
    local host_and_port=${1#http://} line
    host_and_port=${host_and_port%%/*}
    exec 3<>"/dev/tcp/${host_and_port%:*}/${host_and_port##*:}" || return 1
    printf 'GET / HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n' "$host_and_port" >&3
    IFS= read -r -t 30 line <&3
    exec 3>&-
    [[ $line == HTTP/1.?" 200 "* ]]
}

# ./run serve runs until it is stopped, so the script waits for the address that it prints.
serve_on_machine() {
    local log="$logs/serve.log" address="" began=$SECONDS
    say "./run serve … (log: build/fresh-machine/serve.log)"
    start_on "$machine" "$log" ./run serve
    while [ -z "$address" ] && kill -0 "$job" 2>/dev/null; do
        sleep 1
        address=$(sed -n 's/^Studio: //p' "$log")
    done
    [ -n "$address" ] || { finish; keep_build_logs serve; step_failed "./run serve" "$log" "it ended without an address"; }
    answers "$address" || step_failed "./run serve" "$log" "$address does not answer"
    say "./run serve: $address answers after $((SECONDS - began)) s"
    { kill -KILL -- "-$job" && finish; } 2>/dev/null
}

try_configure() {
    new_machine configure
    # Ninja would first write its build file anew, which a dry run does not do: so it gets a copy.
    on_machine configure bash -c 'root=$PWD && . tools/setup.sh && install_packages build run && configure_program release &&
        cd build/release && cp build.ninja dry.ninja && ninja -f dry.ninja -n'
}

try_run() {
    new_machine run
    on_machine run-help ./run --help
    serve_on_machine
}

try_test() {
    new_machine test
    on_machine test ./test
}

steps=()
while [ $# -gt 0 ]; do
    case $1 in
        run | test | configure) steps+=("$1") ;;
        all) steps+=(run test) ;;
        --keep) keep=yes ;;
        --below | --limit)
            [ $# -ge 2 ] || usage $exit_usage >&2
            if [ "$1" = --below ]; then below=$2; else limit_hours=$2; fi
            shift
            ;;
        -h | --help) usage 0 ;;
        *) usage $exit_usage >&2 ;;
    esac
    shift
done
[ ${#steps[@]} -gt 0 ] || steps=(run test)

trap clean_up EXIT
trap 'exit 130' INT TERM HUP
mkdir -p "$packages" || fail "cannot write to $logs."
folder=$(mktemp -d "$below/embody-fresh-machine-XXXXXX") || fail "cannot make a folder below $below." "Name another place: --below DIR"
check_machine
[ -z "$(git -C "$root" status --porcelain --untracked-files=no)" ] || say "Note: what is not committed is not tried."
make_base
for step in "${steps[@]}"; do
    "try_$step"
    cp --no-clobber "$machine"/var/cache/packages/*.deb "$packages/"
    [ $keep = yes ] || rm -rf --one-file-system "$machine"
done
say "All is well: ${steps[*]}"
[ $keep = no ] || say "The machines are in $folder"
