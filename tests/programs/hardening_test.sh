#!/usr/bin/env bash
# Checks that a program has the protections of CMakeLists.txt: hardening_test.sh PROGRAM
set -euo pipefail
export LC_ALL=C

program=$1
failures=0

# expect WHAT PATTERN TEXT: fails if no line of TEXT matches PATTERN
expect() {
  grep -qE "$2" <<<"$3" || { echo "$program: $1: nothing matches $2"; failures=$((failures + 1)); }
}

segments=$(readelf --wide --segments "$program")
dynamic=$(readelf --wide --dynamic "$program")
symbols=$(readelf --wide --dyn-syms "$program")
expect "loaded anywhere" "Elf file type is DYN" "$segments"
expect "read-only relocations" "GNU_RELRO" "$segments"
expect "all relocations at the start" "BIND_NOW|Flags:.* NOW" "$dynamic"
expect "no code on the stack" "GNU_STACK .* RW +0x" "$segments"
expect "stack protector" "__stack_chk_fail" "$symbols"
expect "fortified C library" "__[a-z]+_chk" "$symbols"
expect "assertions of the C++ library" "__glibcxx_assert_fail" "$symbols"
if grep -q "X86-64" <<<"$(readelf --file-header "$program")"; then
  expect "indirect calls end at marked places" "endbr64" "$(objdump --disassemble=main "$program")"
fi
exit $((failures > 0))
