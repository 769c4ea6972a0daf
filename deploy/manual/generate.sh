#!/usr/bin/env bash
# generate.sh BIN DIR: writes the man pages of the programs in BIN to DIR/man1 and their bash completion to
# DIR/completions/tact. bash-completion loads the file named like the program, so the other names are links.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$1 out=$2
programs=(tact tact-bench tact-certify tact-gui tact-prep tact-record tact-refine tact-replay tact-reproduce tact-rt tact-search)
rm -rf "$out/man1" "$out/completions"
mkdir -p "$out/man1" "$out/completions"
cp "$here/completion.bash" "$out/completions/tact"
for program in "${programs[@]}"; do
    "$bin/$program" --manual "$out/man1"
    "$bin/$program" --completion >>"$out/completions/tact"
    [ "$program" = tact ] || ln -s tact "$out/completions/$program"
done
