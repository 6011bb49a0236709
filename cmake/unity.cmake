# A folder's sources are compiled a few at once: what they include is read once, and a template that several of them use is
# compiled once (docs/decisions/0020-build-time.md). The presets `dev`, `debug` and `coverage` compile each alone.
option(EMBODY_UNITY "Compile the sources of a folder together" ON)

# More files a time save less and less, and take longer after a change of one.
set(EMBODY_UNITY_SIZE 8)

# embody_unity(TARGET): folders of more than EMBODY_UNITY_SIZE sources are cut into equal parts. Sources with options of their own
# stay alone (CMake sees to that), and so do those that say so by SKIP_UNITY_BUILD_INCLUSION.
function(embody_unity TARGET)
  if(NOT EMBODY_UNITY)
    return()
  endif()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${TARGET} SOURCES)
  list(SORT sources)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    string(REPLACE "/" "_" name "${name}")
    list(APPEND sources_of_${name} ${source})
    list(APPEND names ${name})
  endforeach()
  list(REMOVE_DUPLICATES names)
  foreach(name IN LISTS names)
    list(LENGTH sources_of_${name} count)
    math(EXPR parts "(${count} + ${EMBODY_UNITY_SIZE} - 1) / ${EMBODY_UNITY_SIZE}")
    set(index 0)
    foreach(source IN LISTS sources_of_${name})
      math(EXPR part "${index} * ${parts} / ${count}")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}_${part})
      math(EXPR index "${index} + 1")
    endforeach()
  endforeach()
endfunction()
