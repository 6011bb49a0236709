# Compile through ccache where there is one.
find_program(EMBODY_CCACHE ccache)
if(EMBODY_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${EMBODY_CCACHE})
endif()
