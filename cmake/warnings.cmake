# Warnings for our own code; libraries come in as SYSTEM.
add_library(embody_warnings INTERFACE)
target_compile_options(embody_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
                       -Woverloaded-virtual -Wnull-dereference -Wmisleading-indentation
                       -Werror=switch  # in every build: a new enumerator names each place that does not know it
                       -Wno-missing-field-initializers)  # designated initialisers leave out what keeps its default
# gcc 12 reports null dereferences, uninitialised uses and (its bug 105651, "text" + string) overlapping copies inside
# the standard library's own inlined code, and (psabi) what gcc 4.6 changed about types as wide as a cache line.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(embody_warnings INTERFACE -Wno-null-dereference -Wno-maybe-uninitialized -Wno-restrict -Wno-psabi)
elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # (psabi) vectors wider than the base registers never leave their source file; clang's -Wshadow means enumerators of
  # a class too.
  target_compile_options(embody_warnings INTERFACE -Wno-psabi -Wno-shadow)
endif()
if(EMBODY_WARNINGS_AS_ERRORS)
  target_compile_options(embody_warnings INTERFACE -Werror)
endif()
