include(${CMAKE_CURRENT_LIST_DIR}/bough-targets.cmake)
