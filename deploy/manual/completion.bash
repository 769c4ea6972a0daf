# Completes tact and its programs in bash 4.2 and later, with or without the package bash-completion.
# The build writes this and the data below, which the programs print from their own options, into one file.
declare -gA _tact_commands=() _tact_options=() _tact_values=() _tact_program=()

# _tact_files [ENDING...]: files that begin like $current with one of these endings (default: any), and folders.
_tact_files() {
    local found ending
    compopt -o filenames 2>/dev/null # fails in tests, where no key was pressed
    while IFS= read -r found; do
        if [ $# = 0 ] || [ -d "${found/#\~/$HOME}" ]; then
            COMPREPLY+=("$found")
            continue
        fi
        for ending in "$@"; do
            [[ ${found,,} == *."$ending" ]] && COMPREPLY+=("$found") && break
        done
    done < <(compgen -f -- "$current")
}

# _tact_offer WORDS: offers the words that begin like $current.
_tact_offer() {
    local word
    for word in $1; do
        [[ $word == "$current"* ]] && COMPREPLY+=("$word")
    done
}

# _tact_offer_values KIND [WORD...]: offers an entry of _tact_values.
_tact_offer_values() {
    local kind=$1 found
    shift
    case $kind in
        words) _tact_offer "$*" ;;
        files) _tact_files "$@" ;;
        folders)
            compopt -o filenames 2>/dev/null
            while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -d -- "$current")
            ;;
    esac
}

_tact_complete() {
    local current=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[0]##*/} option='' word prefix='' place=1 i IFS=$' \t\n'
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if [ -n "$option" ]; then # its value; bash takes = for a word of its own
            [ "$word" = = ] || option=
        elif [[ $word == -* ]]; then
            [ -n "${_tact_values[$command $word]+set}" ] && option=$word
        elif [[ " ${_tact_commands[$command]-} " == *" $word "* ]]; then
            command+=" $word"
            [ -n "${_tact_program[$command]+set}" ] && command=${_tact_program[$command]}
        else
            place=$((place + 1))
        fi
    done
    if [ -n "$option" ]; then
        [ "$current" = = ] && current=
    elif [[ $current == --*=* ]]; then # bash settings in which = does not split words
        option=${current%%=*} prefix=${current%%=*}= current=${current#*=}
    fi
    if [ -n "$option" ]; then
        # shellcheck disable=SC2086  # a kind and words
        _tact_offer_values ${_tact_values[$command $option]-none}
        [ -n "$prefix" ] && COMPREPLY=("${COMPREPLY[@]/#/$prefix}")
    elif [[ $current == -* ]]; then
        _tact_offer "${_tact_options[$command]-}"
    elif [ -n "${_tact_commands[$command]-}" ]; then
        _tact_offer "${_tact_commands[$command]}"
    elif [ -n "${_tact_values[$command $place]-${_tact_values[$command *]-}}" ]; then
        # shellcheck disable=SC2086
        _tact_offer_values ${_tact_values[$command $place]-${_tact_values[$command *]-}}
    else
        _tact_offer "${_tact_options[$command]-}"
    fi
}
complete -F _tact_complete tact tact-bench tact-certify tact-gui tact-prep tact-record tact-refine tact-replay tact-reproduce tact-rt tact-search

