# SPDX-License-Identifier: GPL-3.0-or-later
# fish completion for geomint: the program itself knows what may follow.

function __geomint_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l candidates ($words[1] complete $words[2..-1] "$current" 2>/dev/null)
    if test (count $candidates) -gt 0
        printf '%s\n' $candidates
    else
        # of key=FILE and --option=FILE what stands behind =
        set -l front (string match -r '^[^=]*=' -- "$current")
        set -l stem (string unescape -- (string replace -r '^[^=]*=' '' -- "$current"))
        for path in (__fish_complete_path "$stem")
            printf '%s\n' "$front$path"
        end
    end
end

complete -c geomint -f -a '(__geomint_complete)'
