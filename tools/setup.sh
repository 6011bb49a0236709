# SPDX-License-Identifier: MIT
# Set-up for ./run and ./test: packages, build, front-end, model catalogues. Sourced, not run; the caller sets `root`.
# Every step prints what it does; a failing one prints what failed and what to do.

say() { printf '%s\n' "$*" >&2; }
fail() {
    printf '\nembody: %s\n' "$1" >&2
    [ $# -gt 1 ] && printf '        %s\n' "${@:2}" >&2
    exit 1
}

# Packages of the given groups of packages.txt that are neither installed nor replaced by a command.
missing_packages() {
    local wanted group="" name command line
    wanted=" $* "
    while read -r line; do
        line=${line%%#*}
        case $line in
            \[*\]*) group=${line#[}; group=${group%%]*}; continue ;;
        esac
        read -r name command <<<"$line"
        [ -n "$name" ] || continue
        case $wanted in *" $group "*) ;; *) continue ;; esac
        if [ -n "$command" ] && command -v "${command#\?}" >/dev/null 2>&1; then continue; fi
        printf '%s\n' "$name"
    done <"$root/packages.txt" | while read -r name; do
        grep -qxF "$name" <<<"$installed_packages" || printf '%s\n' "$name"
    done
}

# install_packages GROUP…: as root, or with sudo where that needs no password or a terminal can ask for it.
install_packages() {
    command -v dpkg-query >/dev/null 2>&1 || fail "this set-up is for Debian 12, and dpkg is not here." \
        "Install the packages named in packages.txt by your system's means, then build with: cmake --preset release && cmake --build --preset release"
    local installed_packages missing as_root=()
    installed_packages=$(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' 2>/dev/null | sed -n 's/^ii //p')
    missing=$(missing_packages "$@" | tr '\n' ' ')
    missing=${missing% }
    [ -n "$missing" ] || return 0
    say "Missing Debian packages: $missing"
    if [ "$(id -u)" -ne 0 ]; then
        if command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
            as_root=(sudo)
        else
            fail "packages are missing, and installing them needs root." "Ask an administrator to run:" "  apt-get install --no-install-recommends $missing" "then start again."
        fi
    fi
    local log="$root/build/apt.log"
    mkdir -p "$root/build"
    say "Installing them (log: build/apt.log) …"
    if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing; } >"$log" 2>&1; then
        tail -n 5 "$log" >&2
        fail "installing packages failed; is there a network?" "These are needed:" "  apt-get install --no-install-recommends $missing" "then start again."
    fi
}

# Prints every tenth step of Ninja's output as soon as it is done, and all lines that are no step. (mawk would wait for
# a full block.)
every_tenth_step() {
    local line steps=0
    while IFS= read -r line; do
        case $line in
            "ninja: Entering"* | "ninja: no work"*) ;;
            "["*) steps=$((steps + 1)); [ $((steps % 10)) -ne 0 ] || printf '%s\n' "$line" ;;
            *) printf '%s\n' "$line" ;;
        esac
    done
}

# configure_program PRESET [with-tests]: configures where the build folder is not as wanted. The tests need packages
# that only ./test installs, so they are left out until ./test adds them; then they stay, because every change writes
# the build files anew.
configure_program() {
    local preset=$1 tests=OFF folder="$root/build/$1" log="$root/build/$1.log"
    [ "${2-}" != with-tests ] || tests=ON
    mkdir -p "$root/build"
    # After a failed configuration the settings are newer than the build files.
    if [ "$folder/build.ninja" -nt "$folder/CMakeCache.txt" ] &&
        { [ $tests = OFF ] || grep -qx "EMBODY_TESTS:BOOL=ON" "$folder/CMakeCache.txt"; }; then
        return
    fi
    say "Configuring ($preset) …"
    (cd "$root" && cmake --preset "$preset" -DEMBODY_TESTS=$tests) >"$log" 2>&1 || { tail -n 20 "$log" >&2; fail "configuring failed (log: build/$preset.log)."; }
}

# build_program PRESET TARGET…: builds what changed, or everything where no target is named.
build_program() {
    local preset=$1 log="$root/build/$1.log"
    shift
    [ -x "$root/build/$preset/src/embody" ] || say "Building ($preset); the first time this takes some minutes …"
    # Ninja's own progress line on a terminal, every tenth step elsewhere.
    if [ -t 2 ]; then
        (cd "$root" && NINJA_STATUS="[%f/%t %p] " ninja -C "build/$preset" "$@") >&2 || fail "the build failed." "The compiler's message is above."
    else
        (cd "$root" && NINJA_STATUS="[%f/%t %p] " ninja -C "build/$preset" "$@") 2>&1 | tee "$log" | every_tenth_step >&2
        [ "${PIPESTATUS[0]}" -eq 0 ] || fail "the build failed (log: build/$preset.log)."
    fi
}

# npm without its usual output; errors are kept.
run_npm() {
    local log="$root/build/npm.log"
    (cd "$root/studio" && npm "$@" --no-audit --no-fund --loglevel=error) >"$log" 2>&1 || { tail -n 20 "$log" >&2; fail "npm $* failed in studio/ (log: build/npm.log)." "It needs Node.js 18 or newer ($(node --version 2>/dev/null || echo 'none found')) and, the first time, a network."; }
}

# The front-end: installs packages when the lock file changed, builds the bundle when a source did.
build_studio() {
    local stamp="$root/studio/node_modules/.embody-lock" lock
    lock=$(cksum <"$root/studio/package-lock.json")
    if [ "$(cat "$stamp" 2>/dev/null)" != "$lock" ]; then
        say "Installing the Studio's packages (npm ci) …"
        run_npm ci
        printf '%s\n' "$lock" >"$stamp"
    fi
    if [ ! -f "$root/studio/dist/index.html" ] ||
        [ -n "$(find "$root/studio" -newer "$root/studio/dist/index.html" -type f -not -path '*/node_modules/*' -not -path '*/dist/*' -print -quit)" ]; then
        say "Building the Studio …"
        run_npm run build
    fi
}

# serve_studio PROGRAM DATA serve ARGUMENTS…: becomes the server. Until the catalogues of real models are in the user's own database it
# gets a list of them, which is still written while the Studio is used: what must be downloaded comes when it is there.
serve_studio() {
    local program=$1 data=$2
    shift 2
    case " $* " in *" --database"* | *" --help "* | *" -h "*) exec "$program" "$@" ;; esac
    [ ! -f "$data/catalogues-imported" ] || exec "$program" "$@"
    say "First start: the library is filled with real models while you use the Studio; this takes some minutes, once."
    exec "$program" "$@" --fill-list <(model_catalogues "$data/catalogues") --fill-mark "$data/catalogues-imported"
}

# Prints the catalogues of real models on this machine, one path per line, and after "# " what could not be had. The furniture of Sweet Home 3D's own program
# is in a package that would install Java, too, so only its archive is fetched and unpacked.
model_catalogues() {
    local folder="$1" piece
    for piece in /usr/share/sweethome3d/furniture/*.sh3f; do [ -f "$piece" ] && printf '%s\n' "$piece"; done
    if [ -f /usr/share/sweethome3d/sweethome3d.jar ]; then
        printf '%s\n' /usr/share/sweethome3d/sweethome3d.jar
        return
    fi
    local jar="$folder/usr/share/sweethome3d/sweethome3d.jar"
    if [ ! -f "$jar" ]; then
        local work="$folder/download"
        mkdir -p "$work"
        if (cd "$work" && apt-get download sweethome3d && dpkg-deb -x sweethome3d_*.deb "$folder") >"$root/build/sweethome3d.log" 2>&1; then
            rm -rf "$work"
        else
            printf '%s\n' "# The 100 models of Sweet Home 3D itself could not be downloaded (log: build/sweethome3d.log); the next start tries again."
            return
        fi
    fi
    printf '%s\n' "$jar"
}
