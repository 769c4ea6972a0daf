# Sourced, in the root of the checkout. Configures and builds; prints nothing if there is nothing to do.
#
# Uses ccache if installed; its entries are shared between checkouts.

# Checks that the build folder is writable; reports a read-only file system or a folder of another user.
tact_check_writable() {
    local here
    here=$(pwd -P)
    mkdir -p build 2>/dev/null && [ -w build ] && return 0
    if [ "$(stat -f -c %T . 2>/dev/null)" = "" ] || ! findmnt -n -o OPTIONS -T . 2>/dev/null | grep -qw ro; then
        tact_fail "build in $here" "the folder is not writable for this user ($(id -un); owner: $(stat -c %U .))" \
            "clone it into a folder of your own: git clone '$here' ~/tact"
    else
        tact_fail "build in $here" "the file system is read-only" "clone it elsewhere: git clone '$here' ~/tact"
    fi
}

# Identifies the tools of a build folder: another place, compiler or system needs a new folder.
tact_toolchain() {
    c++ --version 2>/dev/null | head -n 1
    clang++ --version 2>/dev/null | head -n 1
    cmake --version 2>/dev/null | head -n 1
    (. /etc/os-release && echo "$ID ${VERSION_ID:-}") 2>/dev/null
}

# tact_fresh_if_moved PRESET: removes a build folder that was configured elsewhere or by other compilers.
tact_fresh_if_moved() {
    local folder=build/$1 home made
    [ -f "$folder/CMakeCache.txt" ] || return 0
    home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$folder/CMakeCache.txt")
    made=$(cat "$folder/toolchain.txt" 2>/dev/null)
    if ! [ "$home" -ef . ]; then
        echo "This checkout was moved or copied from $home: $folder is configured again."
    elif [ -n "$made" ] && [ "$made" != "$(tact_toolchain)" ]; then
        echo "The compiler or the system has changed: $folder is configured again."
    else
        return 0
    fi
    rm -rf "$folder"
}

# tact_build_estimate PRESET: seconds of a full build: the time of the last one here, else from the processor time on a
# PC of 2023.
tact_build_estimate() {
    local last processor_s
    last=$(awk -v preset="$1" '$1 == preset {seconds = $2} END {print seconds}' build/times.txt 2>/dev/null)
    case $1 in
        release) processor_s=600 ;;
        test) processor_s=700 ;;
        asan) processor_s=1200 ;;
        *) processor_s=600 ;;
    esac
    echo "${last:-$((processor_s / $(nproc)))}"
}

# Shows ninja's steps as progress; passes all other output (warnings, errors) through.
tact_ninja_output() {
    local line done_steps all_steps
    while IFS= read -r line; do
        if [[ $line =~ ^@([0-9]+)/([0-9]+)@ ]]; then
            done_steps=${BASH_REMATCH[1]} all_steps=${BASH_REMATCH[2]}
            tact_share "$((done_steps * 100 / all_steps))" "Building $1, step $done_steps of $all_steps"
        else
            [ -t 1 ] && printf '\r\033[K'
            printf '%s\n' "$line"
        fi
    done
}

# tact_build PRESET [TARGET...]
tact_build() {
    local preset=$1 log=build/configure-$1.log steps start=$SECONDS status
    shift
    tact_check_writable || return
    tact_fresh_if_moved "$preset"
    if command -v ccache >/dev/null && [ -z "${CMAKE_CXX_COMPILER_LAUNCHER+given}" ]; then
        export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
        export CCACHE_SLOPPINESS=pch_defines,time_macros
        # No preprocessing before each compilation. ccache 4.7 keeps the names of headers relative to the checkout in this mode
        # only if the path needs no quotes; otherwise another checkout would watch the headers of this one.
        if [[ $PWD =~ [^A-Za-z0-9/._+-] ]]; then
            export CCACHE_NAMESPACE=quoted  # not the entries that were made in that mode
        else
            export CCACHE_DEPEND=1
        fi
    fi
    if ! cmake --preset "$preset" >"$log" 2>&1; then
        cat "$log" >&2
        tact_fail "configure $preset" "CMake failed (its output is above, and in $log)" \
            "install the missing package; rm -rf build/$preset starts over"
        return
    fi
    tact_toolchain >"build/$preset/toolchain.txt"
    steps=$(ninja -C "build/$preset" -n "$@" 2>/dev/null | sed -n 's/^\[[0-9]*\/\([0-9]*\)\].*/\1/p' | tail -n 1)
    [ "${steps:-0}" -gt 0 ] || return 0
    if [ "${#tact_plan_steps[@]}" = 0 ]; then tact_plan build "$(tact_build_estimate "$preset")"; fi
    tact_step build "Building $preset, $steps steps"
    NINJA_STATUS="@%f/%t@ " cmake --build --preset "$preset" ${1:+--target "$@"} 2>&1 | tact_ninja_output "$preset"
    status=${PIPESTATUS[0]}
    tact_plan_end
    if [ "$status" -ne 0 ]; then
        tact_fail "build $preset" "a step failed (its output is above)" "run rm -rf build/$preset and build again; if it fails again, report it with that output"
        return
    fi
    # Only a build of (nearly) everything predicts the time of the next one.
    if [ "$steps" -gt 100 ]; then echo "$preset $((SECONDS - start)) $steps" >>build/times.txt; fi
}
