# Sourced. A clean room: a minimal Debian in a folder, with its own processes and mounts, apt configured as on the host,
# German locale, and a plain user (anna) with sudo rights. Needs root, mmdebstrap and unshare.
#
#   room_make SUITE         unpacks a room; sets $room. The base archive is kept for a week in build/rooms
#   room_as USER COMMAND    runs COMMAND in a login shell of USER (anna, root) in the room; ends all processes it started
#   room_clone              clones HEAD of this checkout to $room_checkout in the room, owned by anna
#   room_remove             removes the room
#
# ROOM_UNSHARE adds namespaces (--net: no network); ROOM_MOUNT is a command that runs in the room's namespace first.

room_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd) || exit 1
room=''
room_home=/home/anna
room_checkout="$room_home/Prüfstand am Fenster/tact"
room_cache=${TACT_ROOM_CCACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/tact-room-ccache}

room_base() {
    local suite=$1 base=$room_root/build/rooms/$1.tar options=() file mirror
    if [ -n "$(find "$base" -mtime -7 2>/dev/null)" ]; then echo "$base"; return; fi
    # apt in the room needs the host's settings to reach its archive.
    for file in /etc/apt/apt.conf /etc/apt/apt.conf.d/*; do
        grep -qs '^ *Acquire' "$file" && options+=("--aptopt=$file")
    done
    # shellcheck disable=SC2016
    mirror=$(LC_ALL=C apt-get indextargets --format '$(REPO_URI)' 'ORIGIN: Debian' 'LABEL: Debian' | head -n 1)
    mkdir -p "$(dirname "$base")" && rm -f "$base.partial.tar" || return
    mmdebstrap --quiet --mode=root --variant=apt "${options[@]}" --include=ca-certificates,git,locales,login,passwd,sudo \
        --customize-hook='echo "de_DE.UTF-8 UTF-8" >"$1/etc/locale.gen"; chroot "$1" locale-gen >/dev/null' \
        --customize-hook='echo LANG=de_DE.UTF-8 >"$1/etc/default/locale"' \
        --customize-hook='chroot "$1" useradd --create-home --shell /bin/bash --uid 1000 anna' \
        --customize-hook='echo "anna ALL=(ALL) NOPASSWD: ALL" >"$1/etc/sudoers.d/anna"' \
        --customize-hook='printf "127.0.0.1 localhost room\n" >"$1/etc/hosts"; echo room >"$1/etc/hostname"' \
        "$suite" "$base.partial.tar" "${mirror:-http://deb.debian.org/debian}" >&2 &&
        mv "$base.partial.tar" "$base" && echo "$base"
}

room_make() {
    local base
    if [ "$(id -u)" -ne 0 ]; then echo "room: root rights are missing; fix: sudo $0 ..." >&2; return 1; fi
    command -v mmdebstrap >/dev/null || { echo "room: mmdebstrap is missing; fix: apt-get install mmdebstrap" >&2; return 1; }
    base=$(room_base "$1") || { echo "room: creating a minimal Debian $1 failed (see above); fix: check the network and apt's archive" >&2; return 1; }
    room=$(mktemp -d "${TMPDIR:-/var/tmp}/tact-room-$1.XXXXXX") && chmod 755 "$room" && tar -C "$room" -xf "$base" || return
    cp /etc/resolv.conf "$room/etc/resolv.conf" && mkdir -p "$room/ccache" "$room_cache" && chown 1000:1000 "$room_cache"
}

room_remove() {
    [ -n "$room" ] && [ -d "$room/etc" ] && rm -rf --one-file-system "$room"
    room=''
}

room_as() {
    local user=$1
    shift
    [ -n "$room" ] || return 1
    # shellcheck disable=SC2086
    unshare --mount --pid --fork --kill-child --uts --ipc ${ROOM_UNSHARE:-} bash -c '
        set -e
        hostname room
        mount -t proc proc "$1/proc"
        mount --rbind /sys "$1/sys"
        mount -t tmpfs -o mode=755 tmpfs "$1/dev"
        for node in null zero full random urandom tty; do
            touch "$1/dev/$node"; mount --bind "/dev/$node" "$1/dev/$node"
        done
        ln -s /proc/self/fd "$1/dev/fd"; ln -s fd/0 "$1/dev/stdin"; ln -s fd/1 "$1/dev/stdout"; ln -s fd/2 "$1/dev/stderr"
        mkdir "$1/dev/pts" "$1/dev/shm"
        mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts "$1/dev/pts"; ln -s pts/ptmx "$1/dev/ptmx"
        mount -t tmpfs -o mode=1777 tmpfs "$1/dev/shm"
        mount --bind "$2" "$1/ccache"
        eval "${ROOM_MOUNT:-}"
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb chroot "$1" su -l "$3" -c "$4"
    ' room "$room" "$room_cache" "$user" "export CCACHE_DIR=/ccache; $*" </dev/null
}

room_clone() {
    [ -n "$room" ] || return 1
    git -c safe.directory="*" clone --quiet --no-hardlinks "file://$room_root" "$room$room_checkout" &&
        chown -R 1000:1000 "$room$room_home"
}
