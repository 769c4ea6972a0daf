#!/usr/bin/env bash
# deploy/shell: every cause of a failed installation has its own message and fix; a moved checkout is configured again;
# progress percentages grow and end. apt-get, dpkg-query, sudo and id are stubs; the build is a project with one file.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
work=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
failures=0
fail() { echo "FAILED: $1"; failures=$((failures + 1)); }
expect_text() { grep -qF -- "$2" <<<"$1" || fail "expected '$2' in:
$1"; }
expect_none() { ! grep -qF -- "$2" <<<"$1" || fail "did not expect '$2' in:
$1"; }

mkdir "$work/bin"
cat >"$work/bin/apt-get" <<'STUB'
#!/bin/sh
case " $* " in
    *" update --print-uris "*) [ -f "$STUB/no-archive" ] || echo "'file:/archive/dists/stable/InRelease' x 0" ;;
    *print-uris*) printf "'http://a/x.deb' x.deb 12000000 SHA256:0\n'http://a/y.deb' y.deb 500000 SHA256:0\n" ;;
    *" update "*) [ ! -f "$STUB/update" ] || { cat "$STUB/update"; [ ! -f "$STUB/update-once" ] || rm "$STUB/update"; exit 100; } ;;
    *" install "*)
        if [ -f "$STUB/install" ]; then cat "$STUB/install"; [ ! -f "$STUB/install-once" ] || rm "$STUB/install"; exit 100; fi
        printf 'dlstatus:1:50.0:x\npmstatus:lack:50.0:x\n'
        : >"$STUB/installed" ;;
esac
STUB
cat >"$work/bin/dpkg-query" <<'STUB'
#!/bin/sh
printf 'ii  here\n'
[ ! -f "$STUB/installed" ] || printf 'ii  lack\nhi  held\n'
STUB
printf '#!/bin/sh\necho "$HELD"\n' >"$work/bin/apt-mark"
printf '#!/bin/sh\necho "${STUB_UID:-0}"\n' >"$work/bin/id"
chmod +x "$work"/bin/*
printf 'here # a remark\nlack\nheld\n' >"$work/list"
export STUB=$work PATH=$work/bin:$PATH HELD='' TACT_LOCK_SECONDS=3
unset TACT_NO_INSTALL

# install: prints the output and, as the last line, the exit code.
install() {
    rm -f "$work/installed"
    bash -uc '. "$1/deploy/shell/progress.sh"; . "$1/deploy/shell/packages.sh"; tact_install_packages "$2" 2>&1; echo "exit $?"' \
        _ "$root" "$work/list" </dev/null
}

out=$(install)
expect_text "$out" "Missing Debian packages (2): held lack"
expect_text "$out" "With dependencies: 2 packages, 13 MB to download."
expect_text "$out" "Downloading packages"
expect_text "$out" "exit 0"
out=$(bash -uc '. "$1/deploy/shell/packages.sh"; tact_packages_missing "$2"' _ "$root" "$work/list")
[ -z "$out" ] || fail "an installed package that is on hold counts as missing: $out"
out=$(TACT_NO_INSTALL=1 install)
expect_text "$out" "not installed because TACT_NO_INSTALL=1"
expect_text "$out" "exit 0"

touch "$work/no-archive"
out=$(install)
expect_text "$out" "apt knows no package archive"
expect_text "$out" "exit 1"
rm "$work/no-archive"

cause() {  # cause FILE "WHAT APT PRINTS" "WHY" "FIX"
    printf '%s\n' "$2" >"$work/$1"
    local out
    out=$(install)
    expect_text "$out" "$3"
    expect_text "$out" "fix: $4"
    expect_text "$out" "exit 1"
    [ "$(grep -c 'fix:' <<<"$out")" -le 2 ] || fail "more than one message: $out"
    rm -f "$work/$1"
}
cause install "E: Could not get lock /var/lib/dpkg/lock-frontend. It is held by process 42 (apt)" \
    "another package manager still holds its lock after 3 s" "wait for it or end it"
cause update "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 42 (apt)" \
    "another package manager still holds its lock after 3 s" "wait for it or end it"
cause install "E: Unable to locate package lack" "not in the package archives that apt knows: lack" "use Debian 12 or 13"
HELD=libfoo cause install "E: Unable to correct problems, you have held broken packages." \
    "packages on hold are in the way: libfoo" "sudo apt-mark unhold libfoo"
cause install "The following packages have unmet dependencies:
 lack : Depends: libbar (>= 2)" "their dependencies cannot be met: lack : Depends: libbar" "sudo apt-get --fix-broken install"
cause install "E: dpkg was interrupted, you must manually run 'dpkg --configure -a'" "an earlier installation was interrupted" \
    "sudo dpkg --configure -a"
cause install "E: You don't have enough free space in /var/cache/apt/archives/." "the disk is full" "free disk space"
cause update "E: Failed to fetch http://a/x  Connection timed out" "the download was interrupted" "check the network"
cause install "E: something new" "apt-get failed" "as root, run: apt-get install --no-install-recommends held lack"

# A lock that is released in time; also that of the package lists, whose other output is hidden.
printf 'E: Could not get lock /var/lib/apt/lists/lock. It is held by process 42 (apt)\n' >"$work/update"
touch "$work/update-once"
expect_text "$(install)" "Another package manager is at work (held by process 42 (apt)); waiting up to 3 s."
rm -f "$work/update-once"
printf 'E: Could not get lock /var/lib/dpkg/lock-frontend. It is held by process 42 (apt)\n' >"$work/install"
touch "$work/install-once"
out=$(install)
expect_text "$out" "Another package manager is at work (held by process 42 (apt)); waiting up to 3 s."
expect_text "$out" "exit 0"
rm -f "$work/install-once"

# Without root.
out=$(STUB_UID=1000 PATH=$work/bin:/nowhere /bin/bash -uc 'hash -p /usr/bin/awk awk; . "$1/deploy/shell/packages.sh"
    tact_become_root "Installing packages" "apt-get install lack" 2>&1; echo "exit $?"' _ "$root")
expect_text "$out" "sudo is not installed"
expect_text "$out" "as root, run: apt-get install lack"
expect_text "$out" "exit 1"
printf '#!/bin/sh\nexit 1\n' >"$work/bin/sudo"
chmod +x "$work/bin/sudo"
out=$(STUB_UID=1000 setsid bash -uc '. "$1/deploy/shell/packages.sh"
    tact_become_root "Installing packages" "apt-get install lack" 2>&1; echo "exit $?"' _ "$root" </dev/null)
expect_text "$out" "sudo asks for a password, and there is no terminal to ask on"
expect_text "$out" "run first: sudo apt-get install lack"

# What would not end in time is left out, the least telling first: seconds left, seconds of the stage test.
ends() { bash -uc '. "$1/deploy/shell/within.sh"; "tact_$2_for" "$3" "$4"' _ "$root" "$1" "$2" "$3"; }
[ "$(ends room 3000 600)" = --brief ] || fail "a fast machine leaves out tests in the room"
[ "$(ends room 1500 1200)" = --programs ] || fail "the room's tests begin and cannot end"
[ -z "$(ends room 900 1200)" ] || fail "the room begins and cannot end"
[ "$(ends asan 3000 1400)" = whole-with-hil ] || fail "a fast machine leaves out the real-time kernel"
[ "$(ends asan 2400 2000)" = whole ] || fail "the real-time kernel begins and cannot end"
[ "$(ends asan 1600 2800)" = inputs ] || fail "all tests of asan begin and cannot end"
[ -z "$(ends asan 600 3800)" ] || fail "asan begins and cannot end"
[ "$(ends tsan 1000 3800)" = yes ] || fail "a fast machine leaves out tsan"
[ -z "$(ends tsan 600 3800)" ] || fail "tsan begins and cannot end"

# Percentages grow, name the step, and end with the last step of the plan.
out=$(bash -uc '. "$1/deploy/shell/progress.sh"; tact_plan a 60 b 180; tact_step a first; tact_share 50 first
    tact_step b second; for i in 20 40 60 80 100; do tact_share $i second; done; tact_plan_end' _ "$root")
[ "$(sed 's/ *\([0-9]*\) %.*/\1/' <<<"$out" | tr '\n' ' ')" = "0 12 25 40 55 70 85 100 " ] || fail "percentages: $out"
expect_text "$out" "first; about 4 min left"

# A build, a second one, one after the checkout was moved, one with another compiler, a broken one.
mkdir -p "$work/project at home/deploy"
cp -r "$root/deploy/shell" "$work/project at home/deploy/"
cd "$work/project at home" || exit 1
printf 'cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES CXX)\nadd_executable(p p.cpp)\n' >CMakeLists.txt
printf '{"version": 4, "configurePresets": [{"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release"}], "buildPresets": [{"name": "release", "configurePreset": "release"}]}\n' >CMakePresets.json
echo 'int main() {}' >p.cpp
build() {
    PATH=${PATH#"$work/bin:"} bash -uc '. deploy/shell/progress.sh; . deploy/shell/packages.sh; . deploy/shell/build.sh; tact_build release 2>&1; echo "exit $?"'
}
out=$(build)
expect_text "$out" "Building release, 2 steps"
expect_text "$out" "exit 0"
out=$(build)
[ "$out" = "exit 0" ] || fail "a build with nothing to do prints: $out"
mv "$work/project at home" "$work/Prüfstand"
cd "$work/Prüfstand" || exit 1
out=$(build)
expect_text "$out" "This checkout was moved or copied from $work/project at home: build/release is configured again."
expect_text "$out" "exit 0"
./build/release/p || fail "the moved checkout's program does not run"
echo "another compiler" >build/release/toolchain.txt
expect_text "$(build)" "The compiler or the system has changed: build/release is configured again."
echo 'int main() { return wrong; }' >p.cpp
out=$(build)
expect_text "$out" "error: "
expect_text "$out" "build release: a step failed"
expect_text "$out" "exit 1"
echo 'project(' >>CMakeLists.txt
expect_text "$(build)" "configure release: CMake failed"
out=$(sh -c 'true'; bash -uc '. deploy/shell/packages.sh; . deploy/shell/build.sh
    mkdir() { return 1; }; findmnt() { echo ro,noatime; }; tact_check_writable 2>&1')
expect_text "$out" "the file system is read-only"
out=$(bash -uc '. deploy/shell/packages.sh; . deploy/shell/build.sh
    mkdir() { return 1; }; findmnt() { echo rw,noatime; }; tact_check_writable 2>&1')
expect_text "$out" "the folder is not writable for this user"
expect_text "$out" "fix: clone it into a folder of your own"

[ "$failures" -eq 0 ] && echo "all causes explained"
exit "$failures"
