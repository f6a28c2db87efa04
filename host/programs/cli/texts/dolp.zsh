#compdef dolp
local -a found=(${(f)"$(dolp completion words -- "${(@)words[2,CURRENT-1]}" ":$words[CURRENT]")"})
found=(${${found//:/\\:}/$'\t'/:})
if (($#found)); then
  _describe dolp found
else
  _files
fi
