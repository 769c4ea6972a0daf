# Sourced. Shows the progress of long work in percent: on a terminal one line that is overwritten, elsewhere a line at the
# start of each step and after every tenth of the whole.
#
#   tact_plan STEP SECONDS...     the planned steps and their estimated times; starts the clock
#   tact_step STEP TEXT           a step begins; earlier steps are done
#   tact_share PERCENT TEXT       progress of the current step
#   tact_plan_end                 ends the progress line

tact_plan() {
    tact_plan_steps=() tact_plan_seconds=() tact_plan_all=0 tact_plan_before=0 tact_plan_now=0 tact_plan_shown=-1
    tact_plan_text='' tact_plan_start=$SECONDS
    while [ $# -ge 2 ]; do
        tact_plan_steps+=("$1")
        tact_plan_seconds+=("$(($2 > 0 ? $2 : 1))")
        tact_plan_all=$((tact_plan_all + ($2 > 0 ? $2 : 1)))
        shift 2
    done
}

tact_step() {
    local i
    tact_plan_before=0 tact_plan_now=0
    for i in "${!tact_plan_steps[@]}"; do
        if [ "${tact_plan_steps[i]}" = "$1" ]; then
            tact_plan_now=${tact_plan_seconds[i]}
            break
        fi
        tact_plan_before=$((tact_plan_before + tact_plan_seconds[i]))
    done
    tact_share 0 "$2"
}

# 400 -> "about 7 min", 40 -> "less than a minute"
tact_duration() {
    if [ "$1" -lt 60 ]; then echo "less than a minute"; else echo "about $((($1 + 30) / 60)) min"; fi
}

tact_share() {
    local percent left elapsed=$((SECONDS - tact_plan_start))
    percent=$(((tact_plan_before * 100 + tact_plan_now * $1) / (tact_plan_all > 0 ? tact_plan_all : 1)))
    # Early from the plan, then from the elapsed time.
    if [ "$percent" -lt 10 ]; then
        left=$((tact_plan_all - tact_plan_all * percent / 100))
    else
        left=$((elapsed * (100 - percent) / percent))
    fi
    if [ -t 1 ]; then
        printf '\r\033[K%3d %%  %s; %s left' "$percent" "$2" "$(tact_duration "$left")"
        tact_plan_shown=$percent
    elif [ "$2" != "$tact_plan_text" ] && [ "$1" = 0 ] || [ $((percent / 10)) != $((tact_plan_shown / 10)) ]; then
        printf '%3d %%  %s; %s left\n' "$percent" "$2" "$(tact_duration "$left")"
        tact_plan_shown=$percent
    fi
    tact_plan_text=$2
}

tact_plan_end() {
    if [ -t 1 ] && [ "${tact_plan_shown:--1}" -ge 0 ]; then printf '\r\033[K'; fi
    tact_plan_shown=-1 tact_plan_steps=()
}

tact_plan
