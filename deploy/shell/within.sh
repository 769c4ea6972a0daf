# Sourced. What still ends within a time limit, judged by the stage test on this machine.

# tact_asan_for LEFT_S STAGE_S: what of the stage asan ends within LEFT_S seconds on a machine where the stage test took
# STAGE_S: whole-with-hil (the programs on an emulated kernel beside it), whole, inputs (what reads files, devices or
# memory), or nothing.
tact_asan_for() {
    if [ $(($2 * 4 / 3)) -le "$1" ]; then
        echo whole-with-hil
    elif [ "$2" -le "$1" ]; then
        echo whole
    elif [ $(($2 / 2)) -le "$1" ]; then
        echo inputs
    fi
}

# tact_tsan_for LEFT_S STAGE_S: yes, if the stage tsan ends, or nothing.
tact_tsan_for() { [ $(($2 / 4)) -gt "$1" ] || echo yes; }

# tact_room_for LEFT_S STAGE_S: the option of tests/room/try that ends: --brief (build and tests), --programs, or nothing.
tact_room_for() {
    local install_s=200
    if [ $((install_s + $2 * 5 / 4)) -le "$1" ]; then
        echo --brief
    elif [ $((install_s + $2 * 3 / 4)) -le "$1" ]; then
        echo --programs
    fi
}
