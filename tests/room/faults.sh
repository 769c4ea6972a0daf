# Sourced by try: typical faults of new machines. Each step causes the fault in a bare room, prints the message, and checks
# that it is a single message with a fix, within seconds unless a wait makes sense.

# refused SECONDS "PART OF THE MESSAGE" COMMAND...: the command fails in time, with a single message that contains a fix.
refused() {
    local limit=$1 part=$2 start=$SECONDS output
    shift 2
    if output=$("$@" 2>&1); then echo "the command did not fail: $output"; return 1; fi
    printf '%s\n' "$output"
    [ $((SECONDS - start)) -le "$limit" ] || { echo "it took $((SECONDS - start)) s, more than $limit s"; return 1; }
    grep -qF "$part" <<<"$output" || { echo "the message lacks: $part"; return 1; }
    [ "$(grep -cE '^(install packages|Installing packages|build in [^:]*|configure [^:]*): ' <<<"$output")" = 1 ] || { echo "more than one message"; return 1; }
    grep -q '^  fix: ' <<<"$output" || { echo "the message has no fix"; return 1; }
}

ROOM_UNSHARE=--net step "no network" refused 10 "cannot be reached" anna ./deploy/run

printf '%s\n' 'use Fcntl; open F, ">>", $ARGV[0] or die; my $l = pack("s s x4 l! l! i", F_WRLCK, 0, 0, 0, 0); fcntl(F, F_SETLK, $l) or die; sleep $ARGV[1];' >"$room/lock.pl"
locked() {  # locked FILE SECONDS COMMAND: as anna, while root holds the lock
    room_as root "touch $1; perl /lock.pl $1 $2 & sleep 1; su -l anna -c \"cd '$room_checkout' && $3\""
}
step "dpkg's lock is held too long" refused 60 "another package manager still holds its lock" \
    locked /var/lib/dpkg/lock-frontend 120 "TACT_LOCK_SECONDS=4 ./deploy/run"
step "apt's lock is held too long" refused 60 "another package manager still holds its lock" \
    locked /var/lib/apt/lists/lock 120 "TACT_LOCK_SECONDS=4 ./deploy/run"
waits() {
    local output
    output=$(locked /var/lib/apt/lists/lock 8 ". deploy/shell/progress.sh; . deploy/shell/packages.sh; echo xauth >/tmp/list; tact_install_packages /tmp/list && dpkg -s xauth | grep Status" 2>&1)
    printf '%s\n' "$output"
    grep -q "Another package manager is at work" <<<"$output" && grep -q "install ok installed" <<<"$output"
}
step "a lock that is released soon only delays the installation" waits

room_as root 'apt-get update -qq; apt-mark hold libc6 >/dev/null; echo "Package: libc6" >/etc/apt/preferences.d/x'
held() { anna ". deploy/shell/progress.sh; . deploy/shell/packages.sh; echo libc6-dev-held >/tmp/list; tact_install_packages /tmp/list"; }
step "a package in no archive" refused 60 "not in the package archives that apt knows: libc6-dev-held" held
room_as root 'apt-mark unhold libc6 >/dev/null; rm /etc/apt/preferences.d/x'

room_as root 'echo "anna ALL=(ALL) ALL" >/etc/sudoers.d/anna'
step "sudo needs a password, no terminal" refused 20 "sudo asks for a password" anna ./deploy/run
room_as root 'rm /etc/sudoers.d/anna; mv /usr/bin/sudo /usr/bin/sudo.away'
step "no sudo" refused 20 "sudo is not installed" anna ./deploy/run
room_as root 'mv /usr/bin/sudo.away /usr/bin/sudo; echo "anna ALL=(ALL) NOPASSWD: ALL" >/etc/sudoers.d/anna'

ROOM_MOUNT="mount --bind \"\$1$room_checkout\" \"\$1$room_checkout\"; mount -o remount,bind,ro \"\$1$room_checkout\"" \
    step "a read-only checkout" refused 10 "the file system is read-only" anna ./deploy/run
room_as root "chown -R root: '$room_checkout'"
step "another user's checkout" refused 10 "not writable for this user" anna ./deploy/run
room_as root "chown -R anna: '$room_checkout'"

moved() {
    anna ". deploy/shell/progress.sh; . deploy/shell/packages.sh; . deploy/shell/build.sh; tact_install_packages deploy/packages-run.txt >/dev/null && tact_build release tact_base >/dev/null" || return
    room_as anna "mv '$room_checkout' ~/moved && cd ~/moved && . deploy/shell/progress.sh && . deploy/shell/packages.sh && . deploy/shell/build.sh && tact_build release tact_base" |
        tee "$room/moved.txt"
    grep -q "This checkout was moved or copied from $room_checkout: build/release is configured again." "$room/moved.txt"
}
step "a moved checkout" moved
