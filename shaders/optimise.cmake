# Rewrites the SPIR-V file RAW as MODULE so that a driver has less to do at every start: functions are inlined, code is
# in SSA form and, if UNROLL, loops of known count are unrolled. The passes move, copy and delete instructions. They
# change no arithmetic (simplify-instructions would), so results keep their bits.
set(inlining --merge-return --inline-entry-points-exhaustive --eliminate-dead-functions)
set(into_ssa --eliminate-local-single-block --eliminate-local-single-store --scalar-replacement=100 --ssa-rewrite)
set(unrolling --ccp --loop-unroll --scalar-replacement=1000 --convert-local-access-chains --eliminate-local-single-block
              --eliminate-local-single-store --ssa-rewrite)
set(cleaning --ccp --eliminate-dead-branches --eliminate-dead-code-aggressive --merge-blocks --redundancy-elimination
             --eliminate-dead-code-aggressive)
set(passes ${inlining} ${into_ssa})
set(input ${RAW})
if(UNROLL)
  # glslang marks a loop for unrolling only if the loop has an attribute. C++, which compiles the source too, lacks it.
  execute_process(COMMAND ${SPIRV_DIS} ${RAW} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "(OpLoopMerge %[^ ]+ %[^ ]+) None" "\\1 Unroll" text "${text}")
  file(WRITE ${MODULE}.asm "${text}")
  set(input ${MODULE}.marked)
  execute_process(COMMAND ${SPIRV_AS} --target-env vulkan1.2 --preserve-numeric-ids ${MODULE}.asm -o ${input}
                  COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND passes ${unrolling})
endif()
execute_process(COMMAND ${SPIRV_OPT} ${passes} ${cleaning} ${input} -o ${MODULE} COMMAND_ERROR_IS_FATAL ANY)
