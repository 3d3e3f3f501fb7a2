# Writes a source with all migrations of db/FOLDER, which are numbered from 0001 on without a gap, so that they travel inside
# the program: weave_embed_migrations(RESULT FOLDER HEADER FUNCTION). HEADER declares FUNCTION, such as `weave::simd::migrations`;
# RESULT names the source.
function(weave_embed_migrations result folder header function)
  file(GLOB migrations CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/db/${folder}/*.sql)
  list(SORT migrations)
  set(count 0)
  set(entries "")
  foreach(migration ${migrations})
    math(EXPR count "${count} + 1")
    get_filename_component(name ${migration} NAME)
    string(REGEX MATCH "^[0-9][0-9][0-9][0-9]" number ${name})
    math(EXPR number "1${number} - 10000")
    if(NOT number EQUAL count)
      message(FATAL_ERROR "db/${folder}: ${name} should have the number ${count}")
    endif()
    file(READ ${migration} script)
    string(APPEND entries "    {${number}, R\"sql(${script})sql\"},\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${migration})
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${folder}_texts.cpp @ONLY CONTENT
"#include <@header@>

std::span<const weave::sql::Migration> @function@() {
    static constexpr weave::sql::Migration steps[]{
@entries@    };
    return steps;
}
")
  set(${result} ${CMAKE_CURRENT_BINARY_DIR}/${folder}_texts.cpp PARENT_SCOPE)
endfunction()
