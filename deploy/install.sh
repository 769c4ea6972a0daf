#!/usr/bin/env bash
# Sourced by deploy/run and deploy/test: installs the Debian packages of deploy/packages.txt that are missing.
# As a program, `sudo deploy/install.sh --rights` gives a user the rights that real devices need; see its end.
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

# tact_unpack_tool PACKAGE PROGRAM: a program of a package that must not be installed (it starts a server), in
# build/tools. Nothing is run of the package. Prints the folder of the program; fails where it cannot be had.
tact_unpack_tool() {
    local package=$1 program=$2 into=build/tools/$1 found said
    found=$(find "$into" -path "*/bin/$program" -type f 2>/dev/null | head -n 1)
    if [ -z "$found" ]; then
        [ "${TACT_NO_INSTALL:-0}" != 1 ] || return 1
        mkdir -p "$into" || return 1
        if ! said=$(cd "$into" && apt-get download -qq "$package" 2>&1 && dpkg-deb --extract "$package"_*.deb .); then
            echo "unpack $package: $said" >&2
            echo "  mend: check the network, run apt-get update, or put $program into PATH" >&2
            return 1
        fi
        rm -f "$into/$package"_*.deb
        found=$(find "$into" -path "*/bin/$program" -type f | head -n 1)
        [ -n "$found" ] || { echo "unpack $package: there is no $program in it" >&2; return 1; }
    fi
    (cd "$(dirname "$found")" && pwd)
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

# tact_install_rights ROOT USER: puts rules, limits, script and unit below ROOT ("" for the machine itself).
tact_install_rights() {
    local root=$1 here
    here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd) || return 1
    install -D -m 644 "$here/60-tact.rules" "$root/etc/udev/rules.d/60-tact.rules" &&
        install -D -m 644 "$here/limits.conf" "$root/etc/security/limits.d/tact.conf" &&
        install -D -m 755 "$here/can-up" "$root/usr/local/lib/tact/can-up" &&
        install -D -m 644 "$here/tact-can@.service" "$root/etc/systemd/system/tact-can@.service"
}

tact_rights_main() {
    local user=${SUDO_USER:-} root='' group
    while [ $# -gt 0 ]; do
        case $1 in
            --rights) ;;
            --user) user=${2:-}; shift ;;
            --into) root=${2:-}; shift ;;
            *) cat <<'TEXT'
usage: sudo deploy/install.sh --rights [--user NAME] [--into DIR]

Optional: for real devices only; the emulated ones need none of it. Makes the groups tact (devices) and realtime
(priority, locked memory), adds the user to both, and installs
  /etc/udev/rules.d/60-tact.rules        who may open arms and GPIO adapters
  /etc/security/limits.d/tact.conf       real-time limits
  /usr/local/lib/tact/can-up and /etc/systemd/system/tact-can@.service
                                         CAN adapters come up when they are plugged in
  --user NAME  whom to add (default: who called sudo)
  --into DIR   only the files, below DIR: for pictures of other machines
To undo it, remove these files, then: groupdel tact; groupdel realtime
TEXT
                [ "$1" = --help ] || [ "$1" = -h ]
                return ;;
        esac
        shift
    done
    if [ -n "$root" ]; then
        tact_install_rights "$root"
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        echo "install rights: this needs root" >&2
        echo "  mend: sudo deploy/install.sh --rights" >&2
        return 1
    fi
    if [ -n "$user" ] && ! id "$user" >/dev/null 2>&1; then
        echo "install rights: there is no user $user" >&2
        echo "  mend: name one with --user" >&2
        return 1
    fi
    for group in tact realtime; do
        # Before the rules: udev takes no rule whose group it does not know.
        getent group "$group" >/dev/null || groupadd --system "$group" || return 1
        [ -z "$user" ] || [ "$user" = root ] || usermod -aG "$group" "$user" || return 1
    done
    tact_install_rights "" || return 1
    if command -v systemctl >/dev/null && [ -d /run/systemd/system ]; then systemctl daemon-reload; fi
    if command -v udevadm >/dev/null && udevadm control --ping 2>/dev/null; then
        udevadm control --reload && udevadm trigger --subsystem-match=usb --subsystem-match=hidraw \
            --subsystem-match=gpio --subsystem-match=tty --subsystem-match=misc
    else
        echo "install rights: no udev runs here (a container?); the files are in place for a machine where one does"
    fi
    echo "rights installed${user:+ for $user, who has to log in again}; tact probe shows what is seen"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    [ $# -gt 0 ] || set -- --usage
    tact_rights_main "$@"
fi
