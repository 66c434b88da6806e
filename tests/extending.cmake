# The recipes of docs/extending.md are true: cmake -D ROOT=<source folder> -P extending.cmake. Every file that a recipe
# names exists and holds what the recipe says of it, and no other file has a table or a switch over the kind of part.
# (tests/unit/scheme_toy.c and test_recipes.c build a scheme, a joint and a channel by their recipes.)
cmake_minimum_required(VERSION 3.20)

file(READ ${ROOT}/docs/extending.md page)
set(found 0)
macro(complain text)
  message(NOTICE "${text}")
  math(EXPR found "${found} + 1")
endmacro()

# recipe(heading [file word]...): the section under the heading names each file, which contains the word.
function(recipe heading)
  string(REGEX MATCH "\n## ${heading}\n([^#]|\n#[^#]|[^\n]#)*" section "${page}")
  if(NOT section)
    complain("docs/extending.md: no section '${heading}'")
  endif()
  set(rest ${ARGN})
  while(rest)
    list(POP_FRONT rest file word)
    get_filename_component(name ${file} NAME)
    string(FIND "${section}" "${name}" place)
    if(place LESS 0)
      complain("docs/extending.md: '${heading}' does not name ${file}")
    endif()
    if(NOT EXISTS ${ROOT}/${file})
      complain("docs/extending.md: ${file} does not exist")
      continue()
    endif()
    file(READ ${ROOT}/${file} text)
    string(FIND "${text}" "${word}" place)
    if(place LESS 0)
      complain("docs/extending.md: '${heading}': ${file} has no '${word}'")
    endif()
  endwhile()
  set(found ${found} PARENT_SCOPE)
endfunction()

# complete(heading pattern): all files in which the pattern occurs are named in the section.
function(complete heading pattern)
  string(REGEX MATCH "\n## ${heading}\n([^#]|\n#[^#]|[^\n]#)*" section "${page}")
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/core/*.[ch] ${ROOT}/flexbody/*.[ch] ${ROOT}/aero/*.[ch]
    ${ROOT}/cosim/*.[ch] ${ROOT}/apps/*.[ch])
  set(n 0)
  foreach(file IN LISTS files)
    file(STRINGS ${ROOT}/${file} lines REGEX "${pattern}" ENCODING UTF-8)
    if(NOT lines)
      continue()
    endif()
    math(EXPR n "${n} + 1")
    get_filename_component(name ${file} NAME)
    string(FIND "${section}" "${name}" place)
    if(place LESS 0)
      complain("docs/extending.md: '${heading}' does not name ${file}, which has a list of its kinds")
    endif()
  endforeach()
  if(n EQUAL 0)
    complain("docs/extending.md: '${heading}': '${pattern}' occurs nowhere")
  endif()
  set(found ${found} PARENT_SCOPE)
endfunction()

recipe("A coupling scheme" cosim/scheme.h "struct bough_scheme {" cosim/member.h "bough_member_advance"
  cosim/scheme.c "ENTRY(ramp)" tests/unit/scheme_toy.c "const bough_scheme bough_scheme_toy")
complete("A coupling scheme" "ENTRY\\(")

recipe("An integrator" core/solve/integrator.h "typedef struct bough_integrator_ops" core/solve/integrator.c
  "[BOUGH_RADAU5] =" tests/unit/core/solve/test_integrator.c "TEST(")
complete("An integrator" "\\[BOUGH_RADAU5\\]|^    BOUGH_RADAU5,")

recipe("A joint" core/tree/joint.h "typedef enum bough_joint_kind" core/tree/joint.c "[BOUGH_JOINT_PLANAR] ="
  core/tree/constraint.c "BOUGH_JOINT_PLANAR" apps/bough/scene/scene_schema_body.c "WHEN"
  apps/bough/model/build_bodies.c "BOUGH_JOINT_PLANAR" apps/bough/model/channel_table.c
  "[BOUGH_CHANNELS_PLANAR] =" apps/bough/model/observe.c "joint_channels[")
complete("A joint" "case BOUGH_JOINT_(PLANAR|UNIVERSAL)|\\[BOUGH_JOINT_(PLANAR|UNIVERSAL)\\]|^    BOUGH_JOINT_PLANAR,")

recipe("A key of a scene or a study" apps/bough/config/schema_keys.h "#define KEY(" apps/bough/scene/scene_schema.c
  "KEY(" apps/bough/scene/scene_link.c "bough_")
recipe("A channel" apps/bough/model/channel_table.c "[BOUGH_CHANNELS_ROTOR] =")
complete("A channel" "\\[BOUGH_CHANNELS_[A-Z_]+\\] =")
recipe("A command" apps/bough/cli/command.h "bough_command_" apps/bough/cli/main.c "bough_command_")

if(found)
  message(FATAL_ERROR "${found} recipe(s) of docs/extending.md are not true")
endif()
message(STATUS "the recipes hold")
