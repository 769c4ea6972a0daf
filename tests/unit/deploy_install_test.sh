#!/usr/bin/env bash
# cmake --install into a new prefix: every program is installed, hardened and free of build paths, and runs from the prefix
# with the installed configuration, without the build folder in PATH.
# usage: deploy_install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -u
build=$1 source=$2 failures=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $1"; failures=$((failures + 1)); }
prefix="$work/opt tact"
cmake --install "$build" --prefix "$prefix" >"$work/install.log" 2>&1 || { cat "$work/install.log"; exit 1; }
programs="tact tact-bench tact-certify tact-reproduce tact-prep tact-search tact-refine tact-rt tact-gui tact-record tact-replay"
for file in etc/tact/tact.toml etc/security/limits.d/tact.conf lib/udev/rules.d/60-tact.rules lib/tact/can-up \
    lib/systemd/system/tact-can@.service share/applications/tact.desktop share/icons/hicolor/scalable/apps/tact.svg \
    share/mime/packages/tact.xml share/tact/monitoring/tact_rules.yml share/tact/reproduce/draw.py share/doc/tact/README.md; do
    [ -s "$prefix/$file" ] || fail "$file is not installed"
done
[ ! -e "$prefix/bin/tact-emu" ] || fail "test equipment is installed"
for program in $programs; do
    at=$prefix/bin/$program
    [ -x "$at" ] || { fail "$program is not installed"; continue; }
    (cd / && env -i PATH=/nowhere "$at" --version >/dev/null && env -i PATH=/nowhere "$at" --help >"$work/help") || fail "$program does not run from the prefix"
    [ -s "$work/help" ] || fail "$program has no help"
    ! grep -qaF "$source/" "$at" || fail "$program contains a path of the source: $(grep -aoF -m 1 "$source/" "$at" | head -n 1)"
    if [ "$(sed -n 's/^TACT_HARDENING:BOOL=//p' "$build/CMakeCache.txt")" = ON ] && grep -q '^TACT_SANITIZE:STRING=$' "$build/CMakeCache.txt"; then
        readelf -hW "$at" | grep -q 'Type: *DYN' || fail "$program is not position independent"
        readelf -lW "$at" | grep -q GNU_RELRO || fail "$program has no read-only relocations"
        readelf -dW "$at" | grep -q 'BIND_NOW\|FLAGS_1.*NOW' || fail "$program binds lazily"
        readelf -lW "$at" | grep -q 'GNU_STACK .* RW ' || fail "$program has an executable stack"
        readelf -sW --dyn-syms "$at" | grep -q __stack_chk_fail || fail "$program has no stack protector"
        readelf -sW --dyn-syms "$at" | grep -qE '__[a-z]+_chk' || fail "$program has no fortified calls"
    fi
done
# The programs find each other without the build folder in PATH.
cd "$work" || exit 1
if ! env -i PATH=/usr/bin:/bin HOME="$work" "$prefix/bin/tact" demo dock --no-gui --seconds 2 --json "$work/run.json" >"$work/run.log" 2>&1; then
    cat "$work/run.log"
    fail "the demo does not run from the prefix"
fi
grep -qF "tact: configuration $prefix/etc/tact/tact.toml" "$work/run.log" || { cat "$work/run.log"; fail "the installed configuration is not in use"; }
printf '[servo]\nno_such_key = 1\n' >>"$prefix/etc/tact/tact.toml"
! env -i PATH=/usr/bin:/bin HOME="$work" "$prefix/bin/tact" demo dock --no-gui --seconds 1 >"$work/run.log" 2>&1 || fail "an invalid installed configuration is accepted"
command -v desktop-file-validate >/dev/null && { desktop-file-validate "$prefix/share/applications/tact.desktop" || fail "desktop entry"; }
python3 - "$prefix/share/mime/packages/tact.xml" "$prefix/share/icons/hicolor/scalable/apps/tact.svg" <<'PY' || fail "XML"
import sys, xml.etree.ElementTree
for path in sys.argv[1:]: xml.etree.ElementTree.parse(path)
PY
[ "$failures" -eq 0 ] && echo "all programs installed, found and run"
exit "$failures"
