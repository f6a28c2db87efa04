# fish completion of dolp
complete -c dolp -a '(dolp completion words -- (commandline -opc)[2..] :(commandline -ct))'
