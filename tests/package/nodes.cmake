# A node of every family, without exceptions and run-time types, linked to garrison::node alone. Its own code is compiled
# for size, a fifth less in all; the bits are the same.
get_target_property(include garrison::headers INTERFACE_INCLUDE_DIRECTORIES)
string(REGEX REPLACE "\\$<BUILD_INTERFACE:([^>]+)>.*" "\\1" include "${include}")  # of a checkout
file(READ ${include}/garrison/filters/families.hpp list)
string(REGEX MATCH "FamilyList<([A-Za-z, \n]+)>;" list "${list}")
string(REGEX MATCHALL "[A-Za-z]+" families "${CMAKE_MATCH_1}")
foreach(family ${families})
  add_executable(node_${family} ${CMAKE_CURRENT_LIST_DIR}/node.cpp)
  target_compile_definitions(node_${family} PRIVATE FAMILY=${family})
  target_compile_options(node_${family} PRIVATE -Os -fno-exceptions -fno-rtti -ffunction-sections -fdata-sections)
  target_link_options(node_${family} PRIVATE -Wl,--gc-sections)
  target_link_libraries(node_${family} PRIVATE garrison::node)
endforeach()
