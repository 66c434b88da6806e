# Who may include whom: cmake -D ROOT=<source folder> -P layers.cmake. Every violation is printed as
# file:line. The arrows are those of the folder map in README.md.
cmake_minimum_required(VERSION 3.20)

set(found 0)

# Reports each line of the file that matches the pattern, "first" if it is not allowed.
function(forbid file pattern reason)
  file(STRINGS ${ROOT}/${file} hits REGEX "${pattern}" ENCODING UTF-8)
  if(NOT hits)
    return()
  endif()
  # Only now the line numbers: a semicolon or bracket in C would split a CMake list.
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "[][;\\]" " " text "${text}")
  string(REPLACE "\n" ";" lines "${text}")
  set(number 0)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(line MATCHES "${pattern}")
      message(NOTICE "${file}:${number}: ${reason}: ${line}")
      math(EXPR found "${found} + 1")
    endif()
  endforeach()
  set(found ${found} PARENT_SCOPE)
endfunction()

# Files of a folder may include the project's headers only from the folders given.
function(layer folder)
  file(GLOB files RELATIVE ${ROOT} ${ROOT}/${folder}/*.c ${ROOT}/${folder}/*.h)
  foreach(file IN LISTS files)
    foreach(other core flexbody aero cosim apps tests)
      set(allowed FALSE)
      foreach(may IN LISTS ARGN)
        if(may STREQUAL other)
          set(allowed TRUE)
        endif()
      endforeach()
      if(NOT allowed)
        forbid(${file} "^[ \t]*#[ \t]*include[ \t]*\"${other}/" "${folder}/ may not include ${other}/")
      endif()
    endforeach()
    forbid(${file} "^[ \t]*#[ \t]*include[ \t]*\"([^/\"]*|\\.\\./[^\"]*)\""
      "name the folder, from the project's root")
  endforeach()
  set(found ${found} PARENT_SCOPE)
endfunction()

# Only files whose path matches `owner` may contain the pattern.
function(owned_by owner pattern reason)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/core/*.[ch] ${ROOT}/flexbody/*.[ch]
    ${ROOT}/aero/*.[ch] ${ROOT}/cosim/*.[ch] ${ROOT}/apps/*.[ch])
  foreach(file IN LISTS files)
    if(NOT file MATCHES "${owner}")
      forbid(${file} "${pattern}" "${reason}")
    endif()
  endforeach()
  set(found ${found} PARENT_SCOPE)
endfunction()

set(include "^[ \t]*#[ \t]*include[ \t]*<")

layer(core core)
layer(flexbody core flexbody)
layer(aero core aero)
layer(cosim core cosim)

# An app folder includes of the apps only those given.
function(app folder)
  file(GLOB files RELATIVE ${ROOT} ${ROOT}/apps/${folder}/*.[ch])
  foreach(file IN LISTS files)
    foreach(other config scene output simulation analysis loads report import study api bough)
      if(NOT other STREQUAL folder AND NOT other IN_LIST ARGN)
        forbid(${file} "^[ \t]*#[ \t]*include[ \t]*\"apps/${other}/"
          "apps/${folder}/ may not include apps/${other}/")
      endif()
    endforeach()
  endforeach()
  set(found ${found} PARENT_SCOPE)
endfunction()

foreach(folder scene simulation analysis output report import api study bough)
  layer(apps/${folder} core flexbody aero cosim apps)
endforeach()
layer(apps/config core apps)
layer(apps/output core apps)
app(config)
app(output)
app(scene config)
app(simulation config scene output)
app(analysis config scene output simulation)
app(report output)
app(import config scene output)
app(api config scene output simulation)
app(loads output)
app(study config scene output simulation analysis loads)

file(GLOB files RELATIVE ${ROOT} ${ROOT}/cosim/*.[ch])
foreach(file IN LISTS files)
  forbid(${file} "(^|[^A-Za-z])([Rr]od|[Tt]ree|[Bb]lade)s?($|[^A-Za-z])" "cosim/ sees only the contract")
endforeach()

owned_by("^core/linalg\\.c$" "${include}(lapacke?|cblas)|[^A-Za-z0-9_][sdcz][a-z][a-z0-9]+_[ \t]*\\("
  "only core/linalg.c calls LAPACK")
owned_by("^core/integrator_ida\\.c$" "${include}ida/" "only core/integrator_ida.c uses IDA")
owned_by("^flexbody/[^/]*\\.c$" "${include}(cvode|arkode)/" "only flexbody/*.c uses CVODE and ARKODE")
owned_by("^(core|flexbody)/" "${include}(sundials|nvector|sunmatrix|sunlinsol)"
  "only core/ and flexbody/ use SUNDIALS")
owned_by("^core/pool\\.c$" "${include}omp\\.h|#[ \t]*pragma[ \t]+omp[ \t]+([^s]|s[^i])|[^a-z_]omp_[a-z]"
  "only core/pool.c uses OpenMP, but for simd loops")
owned_by("^none$" "pthread_create|thrd_create" "threads are OpenMP's")
owned_by("^apps/config/text\\.c$" "${include}yaml\\.h" "only apps/config/text.c uses libyaml")

owned_by("^apps/output/vertices\\.c$" "${include}hdf5\\.h" "only apps/output/vertices.c uses HDF5")

if(found)
  message(FATAL_ERROR "${found} violation(s) of the layers")
endif()
message(STATUS "layers are as drawn")
