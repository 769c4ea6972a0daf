# Sourced by deploy/run and deploy/test: installs the Debian packages of deploy/packages.txt that are missing.
#
# Quick when nothing is missing: dpkg is asked once. Uses sudo only if the user is not root. TACT_NO_INSTALL=1
# skips the installation and only says what is missing.

# Prints the packages of a list that are not installed.
tact_packages_missing() {
    local list=$1 wanted installed
    wanted=$(sed 's/#.*//' "$list" | tr -s ' \t\n' '\n' | sed '/^$/d' | sort -u)
    # shellcheck disable=SC2086
    installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' $wanted 2>/dev/null | awk '$1 == "ii" {print $2}' | sort -u)
    comm -23 <(printf '%s\n' "$wanted") <(printf '%s\n' "$installed")
}

tact_install_packages() {
    local list=$1 missing
    local -a as_root=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "install packages: this is no Debian system (dpkg-query or apt-get is missing)" >&2
        echo "  mend: install what $list names by other means and set TACT_NO_INSTALL=1" >&2
        [ "${TACT_NO_INSTALL:-0}" = 1 ]
        return
    fi
    missing=$(tact_packages_missing "$list")
    [ -n "$missing" ] || return 0
    # shellcheck disable=SC2086
    echo "packages to install:" $missing
    if [ "${TACT_NO_INSTALL:-0}" = 1 ]; then
        echo "not installed, because TACT_NO_INSTALL=1" >&2
        return 0
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "install packages: you are not root and there is no sudo" >&2
            # shellcheck disable=SC2086
            echo "  mend: as root, run: apt-get install --no-install-recommends" $missing >&2
            return 1
        fi
        as_root=(sudo)
    fi
    # shellcheck disable=SC2086
    if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq ||
       ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 $missing >/dev/null; then
        echo "install packages: apt-get failed (its words are above)" >&2
        echo "  mend: check the network and /etc/apt/sources.list, then run this again" >&2
        return 1
    fi
    missing=$(tact_packages_missing "$list")
    if [ -n "$missing" ]; then
        # shellcheck disable=SC2086
        echo "install packages: still missing:" $missing >&2
        return 1
    fi
}

# tact_build PRESET [TARGET...]: configures when needed and builds. Says nothing when there is nothing to do. A
# compiler cache is used where one is installed; what it holds of other checkouts fits this one too.
tact_build() {
    local preset=$1 log=build/configure-$1.log
    shift
    mkdir -p build
    if command -v ccache >/dev/null && [ -z "${CMAKE_CXX_COMPILER_LAUNCHER+given}" ]; then
        export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
        export CCACHE_SLOPPINESS=pch_defines,time_macros
    fi
    if ! cmake --preset "$preset" >"$log" 2>&1; then
        cat "$log" >&2
        echo "configure $preset: failed (its words are above)" >&2
        return 1
    fi
    NINJA_STATUS="$preset [%f/%t] " cmake --build --preset "$preset" ${1:+--target "$@"}
}
