# Sourced. Installs the missing Debian packages of given lists. Does nothing if none is missing (one call of dpkg-query).
# Uses sudo only if the user is not root.
#
#   TACT_NO_INSTALL=1    only report what is missing
#   TACT_LOCK_SECONDS=N  maximum wait for another package manager (default 180)
#
# Every failure ends with one message of three parts: the attempt, the cause, the fix.

# tact_fail ATTEMPT CAUSE FIX...: prints that message, each FIX on a line of its own.
tact_fail() {
    local fix
    printf '\n%s: %s\n' "$1" "$2" >&2
    shift 2
    for fix in "$@"; do printf '  fix: %s\n' "$fix" >&2; done
    return 1
}

# Prints the packages of the lists that are not installed.
tact_packages_missing() {
    local wanted installed
    wanted=$(cat "$@" | sed 's/#.*//' | tr -s ' \t\n' '\n' | sed '/^$/d' | sort -u)
    # shellcheck disable=SC2086
    installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' $wanted 2>/dev/null | awk '$1 ~ /^.i$/ {print $2}' | sort -u)
    comm -23 <(printf '%s\n' "$wanted") <(printf '%s\n' "$installed")
}

# Sets tact_as_root to the command prefix for root; asks for a password if there is a terminal.
tact_become_root() {
    local reason=$1 by_hand=$2
    tact_as_root=()
    [ "$(id -u)" -ne 0 ] || return 0
    if ! command -v sudo >/dev/null; then
        tact_fail "$reason" "this user is not root, and sudo is not installed" "as root, run: $by_hand"
        return
    fi
    tact_as_root=(sudo)
    LC_ALL=C sudo -n true 2>/dev/null && return 0
    if ! { true </dev/tty; } 2>/dev/null; then
        tact_fail "$reason" "sudo asks for a password, and there is no terminal to ask on" \
            "start this in a terminal, or run first: sudo $by_hand"
        return
    fi
    echo "$reason needs root: sudo asks for your password."
    sudo -v </dev/tty && return 0
    tact_fail "$reason" "sudo was refused (see above)" "as root, run: $by_hand" \
        "or let an administrator add you to the group sudo: adduser $(id -un) sudo"
}

# Checks that the first package archive can be reached; takes seconds, where apt itself would try for minutes.
tact_archive_reached() {
    local uri
    uri=$(LC_ALL=C apt-get update --print-uris 2>/dev/null | sed -n "s/^'\([^']*InRelease\)'.*/\1/p" | head -n 1)
    if [ -z "$uri" ]; then
        tact_fail "install packages" "apt knows no package archive (/etc/apt/sources.list and sources.list.d are empty)" \
            "add: deb http://deb.debian.org/debian $(. /etc/os-release && echo "$VERSION_CODENAME") main"
        return
    fi
    case $uri in http:* | https:*) ;; *) return 0 ;; esac  # a disk or a mirror on this machine: apt reports problems
    # In /tmp, where apt's own user may write.
    local probe
    probe=$(mktemp -d /tmp/tact-probe.XXXXXX) && chmod 755 "$probe"
    if ! LC_ALL=C timeout 8 /usr/lib/apt/apt-helper -o Acquire::Retries=0 -o Acquire::http::Timeout=6 \
        -o Acquire::https::Timeout=6 -o APT::Sandbox::User=root -qq download-file "$uri" "$probe/InRelease" >"$probe/log" 2>&1; then
        tact_fail "install packages" "the package archive ${uri%/dists/*} cannot be reached: $(grep -m 1 -oE 'Temporary failure resolving.*|Could not .*|Connection .*|[0-9]{3} .*' "$probe/log" || echo 'no answer within 8 s')" \
            "check the network, the proxy (/etc/apt/apt.conf.d) and /etc/apt/sources.list; then run this again" \
            "without a network: install the packages by other means, then set TACT_NO_INSTALL=1"
        rm -rf "$probe"
        return 1
    fi
    rm -rf "$probe"
}

# Explains a failure of apt-get from its output.
tact_explain_apt() {
    local log=$1 missing=$2 held
    held=$(apt-mark showhold 2>/dev/null | xargs)
    if grep -q 'Could not get lock\|is another process using it' "$log"; then
        tact_fail "install packages" "another package manager still holds its lock after ${TACT_LOCK_SECONDS:-180} s: $(grep -m 1 -o 'Could not get lock.*' "$log")" \
            "wait for it or end it (ps -fp NUMBER), then run this again"
    elif grep -q 'Unable to locate package\|has no installation candidate' "$log"; then
        tact_fail "install packages" "not in the package archives that apt knows: $(grep -oE "(Unable to locate package|Package) '?[a-z0-9.+-]+" "$log" | awk '{print $NF}' | tr -d "'" | sort -u | tr '\n' ' ')" \
            "use Debian 12 or 13 with its component main; this is $(. /etc/os-release && echo "$PRETTY_NAME")"
    elif grep -q 'held broken packages\|unmet dependencies\|held packages were changed' "$log"; then
        if [ -n "$held" ]; then
            tact_fail "install packages" "packages on hold are in the way: $held" \
                "sudo apt-mark unhold $held, or release them one at a time; $log has apt's reasons"
        else
            tact_fail "install packages" "their dependencies cannot be met: $(grep -m 1 -A 1 'unmet dependencies' "$log" | tail -n 1 | xargs)" \
                "sudo apt-get --fix-broken install; remove packages of other releases; $log has apt's reasons"
        fi
    elif grep -q 'dpkg was interrupted' "$log"; then
        tact_fail "install packages" "an earlier installation was interrupted" "sudo dpkg --configure -a; then run this again"
    elif grep -q "don't have enough free space\|No space left" "$log"; then
        tact_fail "install packages" "the disk is full" "free disk space on $(df --output=target /var/cache/apt | tail -n 1), e.g. sudo apt-get clean"
    elif grep -q 'Temporary failure resolving\|Could not connect\|Connection timed out\|Connection failed\|Failed to fetch' "$log"; then
        tact_fail "install packages" "the download was interrupted: $(grep -m 1 'Failed to fetch\|Could not\|Connection' "$log")" \
            "check the network, then run this again; downloaded files are kept"
    else
        tail -n 15 "$log" >&2
        tact_fail "install packages" "apt-get failed (its last lines are above)" "as root, run: apt-get install --no-install-recommends $missing"
    fi
}

# Reads apt-get's output: shows its progress, writes all other lines to the log.
tact_apt_output() {
    local line
    : >"$1"
    while IFS= read -r line; do
        case $line in
            dlstatus:*) line=${line#*:*:}; line=${line%%[.:]*}; tact_share "$((line / 3))" "Downloading packages" ;;
            pmstatus:*) line=${line#*:*:}; line=${line%%[.:]*}; tact_share "$((33 + line * 2 / 3))" "Installing packages" ;;
            pmerror:*) ;;  # the log has the error text
            *) printf '%s\n' "$line" >>"$1" ;;
        esac
    done
}

# tact_apt LOG ARGUMENT...: runs apt-get as root. Waits while another package manager holds a lock.
tact_apt() {
    local log=$1 until=$((SECONDS + ${TACT_LOCK_SECONDS:-180})) told=0 status
    shift
    while :; do
        # Progress comes on a descriptor of its own: apt closes it for the packages' scripts, which need their output.
        # shellcheck disable=SC2016
        "${tact_as_root[@]}" env LC_ALL=C.UTF-8 LANGUAGE= DEBIAN_FRONTEND=noninteractive sh -c 'exec apt-get "$@" 3>&1' \
            apt -q -y -o Dpkg::Use-Pty=0 -o Acquire::Retries=1 -o APT::Status-Fd=3 "$@" 2>&1 | tact_apt_output "$log"
        status=${PIPESTATUS[0]}
        [ "$status" -ne 0 ] || return 0
        grep -q 'Could not get lock\|Unable to lock directory' "$log" && [ "$SECONDS" -lt "$until" ] || return "$status"
        if [ "$told" = 0 ]; then
            told=1
            echo "Another package manager is at work ($(grep -m 1 -o 'held by process.*' "$log" || echo "its lock is taken")); waiting up to ${TACT_LOCK_SECONDS:-180} s." >&2
        fi
        sleep 2
    done
}

# tact_install_packages [--before-build SECONDS] LIST...: SECONDS is the estimated time of a build that follows, so that
# progress covers both. Leaves the plan (progress.sh) open for that build.
tact_install_packages() {
    local build_s=0 missing count log bytes by_hand
    if [ "$1" = --before-build ]; then build_s=$2; shift 2; fi
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        [ "${TACT_NO_INSTALL:-0}" = 1 ] && return 0
        tact_fail "install packages" "this is not a Debian system (dpkg-query or apt-get is missing)" \
            "install the packages listed in $* by other means, then set TACT_NO_INSTALL=1"
        return
    fi
    missing=$(tact_packages_missing "$@" | tr '\n' ' ')
    missing=${missing% }
    [ -n "$missing" ] || return 0
    if [ "${TACT_NO_INSTALL:-0}" = 1 ]; then
        echo "Missing packages, not installed because TACT_NO_INSTALL=1: $missing" >&2
        return 0
    fi
    by_hand="apt-get install --no-install-recommends $missing"
    tact_archive_reached || return
    tact_become_root "Installing packages" "$by_hand" || return
    log=$(mktemp /tmp/tact-apt.XXXXXX) || return
    count=$(wc -w <<<"$missing")
    echo "Missing Debian packages ($count): $missing"
    # shellcheck disable=SC2086
    if ! tact_apt "$log" update >/dev/null; then
        tact_explain_apt "$log" "$missing"
        return
    fi
    # shellcheck disable=SC2086
    bytes=$(LC_ALL=C apt-get -qq --print-uris -y --no-install-recommends install $missing 2>/dev/null |
        awk '{packages++; bytes += $3} END {printf "%d %d", packages, bytes}')
    count=${bytes% *} bytes=${bytes#* }
    if [ "$count" -gt 0 ]; then
        echo "With dependencies: $count packages, $(((bytes + 999999) / 1000000)) MB to download."
        [ "$build_s" = 0 ] || echo "Then the build: $(tact_duration "$build_s") on $(nproc) processor cores."
    fi
    tact_plan packages "$((bytes / 8000000 + count / 5 + 1))" build "$build_s"
    tact_step packages "Downloading packages"
    # shellcheck disable=SC2086
    if ! tact_apt "$log" install --no-install-recommends $missing; then
        tact_plan_end
        tact_explain_apt "$log" "$missing"
        return
    fi
    rm -f "$log"
    [ "$build_s" != 0 ] || tact_plan_end
    missing=$(tact_packages_missing "$@" | tr '\n' ' ')
    [ -z "$missing" ] || tact_fail "install packages" "still missing after the installation: $missing" "sudo $by_hand"
}

# tact_unpack_tool PACKAGE PROGRAM: unpacks a program of a package that must not be installed (it starts a server) to
# build/tools, without running anything of the package. Prints the folder of the program; fails if it is not available.
tact_unpack_tool() {
    local package=$1 program=$2 into=build/tools/$1 found output
    found=$(find "$into" -path "*/bin/$program" -type f 2>/dev/null | head -n 1)
    if [ -z "$found" ]; then
        [ "${TACT_NO_INSTALL:-0}" != 1 ] || return 1
        mkdir -p "$into" || return 1
        if ! output=$(cd "$into" && apt-get download -qq "$package" 2>&1 && dpkg-deb --extract "$package"_*.deb .); then
            echo "unpack $package: $output" >&2
            echo "  fix: check the network, run apt-get update, or put $program into PATH" >&2
            return 1
        fi
        rm -f "$into/$package"_*.deb
        found=$(find "$into" -path "*/bin/$program" -type f | head -n 1)
        [ -n "$found" ] || { echo "unpack $package: the package does not contain $program" >&2; return 1; }
    fi
    (cd "$(dirname "$found")" && pwd)
}
