#!/usr/bin/env bash
# `sudo deploy/install.sh --rights` gives a user the rights that real devices need. ./deploy/run and ./deploy/test install
# the packages of packages-run.txt and packages-test.txt themselves (shell/packages.sh).

# tact_install_rights ROOT USER: installs rules, limits, script and unit below ROOT ("" for this machine).
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

Optional: only real devices need this. Creates the groups tact (devices) and realtime
(priority, locked memory), adds the user to both, and installs
  /etc/udev/rules.d/60-tact.rules        access to arms and GPIO adapters
  /etc/security/limits.d/tact.conf       real-time limits
  /usr/local/lib/tact/can-up and /etc/systemd/system/tact-can@.service
                                         CAN adapters come up when they are plugged in
  --user NAME  user to add (default: the user of sudo)
  --into DIR   install only the files, below DIR: for images of other machines
To undo this, remove these files, then: groupdel tact; groupdel realtime
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
        echo "install rights: the command needs root" >&2
        echo "  fix: sudo deploy/install.sh --rights" >&2
        return 1
    fi
    if [ -n "$user" ] && ! id "$user" >/dev/null 2>&1; then
        echo "install rights: the user $user does not exist" >&2
        echo "  fix: name an existing user with --user" >&2
        return 1
    fi
    for group in tact realtime; do
        # Create the groups before the rules: udev rejects a rule with an unknown group.
        getent group "$group" >/dev/null || groupadd --system "$group" || return 1
        [ -z "$user" ] || [ "$user" = root ] || usermod -aG "$group" "$user" || return 1
    done
    tact_install_rights "" || return 1
    if command -v systemctl >/dev/null && [ -d /run/systemd/system ]; then systemctl daemon-reload; fi
    if command -v udevadm >/dev/null && udevadm control --ping 2>/dev/null; then
        udevadm control --reload && udevadm trigger --subsystem-match=usb --subsystem-match=hidraw \
            --subsystem-match=gpio --subsystem-match=tty --subsystem-match=misc
    else
        echo "install rights: udev does not run here (a container?); the files are in place for a machine with udev"
    fi
    echo "rights installed${user:+ for $user, who must log in again}; tact probe lists the detected devices"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    [ $# -gt 0 ] || set -- --usage
    tact_rights_main "$@"
fi
