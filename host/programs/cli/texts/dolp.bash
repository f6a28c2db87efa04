# bash completion of dolp
_dolp() {
  local current=${COMP_WORDS[COMP_CWORD]} begin= at=$COMP_CWORD
  [[ $current != = ]] || { current= at=$((COMP_CWORD - 1)) begin=${COMP_WORDS[COMP_CWORD - 1]}=; }
  [[ ${COMP_WORDS[COMP_CWORD - 1]} != = ]] || { at=$((COMP_CWORD - 2)) begin=${COMP_WORDS[COMP_CWORD - 2]}=; }
  mapfile -t COMPREPLY < <(dolp completion words -- "${COMP_WORDS[@]:1:at-1}" ":$begin$current" | cut -f1)
  COMPREPLY=("${COMPREPLY[@]#"$begin"}")  # bash cuts KEY=WORD in three
  [[ ${COMPREPLY[*]} != *= ]] || compopt -o nospace 2>/dev/null
}
complete -o default -F _dolp dolp
