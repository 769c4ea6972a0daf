# Sourced. Which clean room (tests/room) still ends within a time limit.

# tact_room_for LEFT_S STAGE_S: the option of tests/room/try that ends within LEFT_S seconds on a machine where the stage
# test took STAGE_S: --brief (build and tests), --programs, or nothing.
tact_room_for() {
    local install_s=200
    if [ $((install_s + $2 * 5 / 4)) -le "$1" ]; then
        echo --brief
    elif [ $((install_s + $2 * 3 / 4)) -le "$1" ]; then
        echo --programs
    fi
}
