# SPDX-License-Identifier: GPL-3.0-or-later
# bash completion for geomint: the program itself knows what may follow.

_geomint() {
    local line=${COMP_LINE:0:COMP_POINT} candidate
    local -a words
    # with its backslashes understood: a blank behind one belongs to the word
    # shellcheck disable=SC2162
    read -a words <<<"$line"
    [[ $line == *[[:blank:]] ]] && words+=("")
    local current=${words[-1]} front=
    # readline replaces only what stands behind the last =
    [[ $COMP_WORDBREAKS == *=* && $current == *=* ]] && front=${current%"${current##*=}"}
    COMPREPLY=()
    while IFS=$'\t' read -r candidate _; do
        COMPREPLY+=("${candidate#"$front"}")
    done < <("$1" complete "${words[@]:1}" 2>/dev/null)
    if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] || [[ ${#COMPREPLY[@]} -gt 0 && $current == *=* ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o default -F _geomint geomint
