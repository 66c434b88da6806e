# Completion of bough's command line in bash. The program is asked, so that nothing here grows old.
_bough() {
    local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words files=-f
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        words=$("$1" --help | sed -n 's/^  bough \([^ ]*\).*/\1/p') files=
    elif [ "$command" = help ] || [ "$command" = --help ]; then
        words=$("$1" --help | sed -n 's/^  bough \([a-z][^ ]*\).*/\1/p
            /^topics/,/^$/s/^  \([^ ]*\).*/\1/p') files=
    elif [ "$command" = import ] && [ "$COMP_CWORD" -eq 2 ]; then
        words=$("$1" help import | grep -o "'[a-z]*" | tr -d "'") files=
    elif [ "$command" = new ] && [ "$COMP_CWORD" -eq 2 ]; then
        words='beam mechanism turbine' files=
    elif [ "${word#-}" != "$word" ]; then
        words=$("$1" help "$command" 2>/dev/null | sed -n 's/^  \(-h, \)\{0,1\}\(--[a-z-]*\).*/\2/p') files=
    fi
    while IFS= read -r word; do
        COMPREPLY+=("$word")
    done < <(compgen $files -W "$words" -- "$word")
}
complete -o filenames -F _bough bough
