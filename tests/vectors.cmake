# Whether the loops over segments, vertices and stations are in vector lanes: a compiler that stops inlining a
# kernel runs them one by one, with the same results. cmake -D OBJDUMP=… -D OBJECTS=<list> -P vectors.cmake.
cmake_minimum_required(VERSION 3.20)

# In the functions whose names match, packed operations are at least `least`: a third of what gcc 12 makes.
function(expect file functions least)
  set(objects ${OBJECTS})
  list(FILTER objects INCLUDE REGEX "/${file}\\.c\\.o$")
  execute_process(COMMAND ${OBJDUMP} -d --no-show-raw-insn ${objects} OUTPUT_VARIABLE text
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "[][;\\]" " " text "${text}")
  string(REGEX REPLACE "\n\n" ";" parts "${text}")
  list(FILTER parts INCLUDE REGEX "<(${functions})[.>]")
  set(count 0)
  foreach(part IN LISTS parts)
    if(part MATCHES "^[0-9a-f]+ <(${functions})[.>]")
      string(REGEX MATCHALL "\tv?(fn?m)?(add|sub|mul)[0-9]*pd" packed "${part}")
      list(LENGTH packed length)
      math(EXPR count "${count} + ${length}")
    endif()
  endforeach()
  message(STATUS "${file}.c, ${functions}: ${count} packed operations, at least ${least}")
  if(count LESS least)
    message(SEND_ERROR "${file}.c: loops of ${functions} are not in vector lanes")
  endif()
endfunction()

expect(rod_force_kernel "find_forces" 180)
expect(rod_force_kernel "balance_vertices|vertex_accelerations|bough_rod_derivative_v3" 130)
expect(rod_tangent_kernel "position_variation|velocity_variation|linearise_eight|bough_rod_linearise_v3" 790)
expect(rod_newton_kernel "bough_rod_solve_v3" 130)
expect(rotor_load_kernel "bough_rotor_load_v3" 100)
expect(induction_kernel "evaluate|bough_induction_solve_v3" 100)
expect(stall_kernel "bough_stall_advance_v3" 130)
