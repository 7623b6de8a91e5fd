# How every target is compiled. Included once, from the top.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
# Modules that are loaded when they are needed lie beside the programs.
set(CMAKE_BUILD_RPATH "$ORIGIN")
set(CMAKE_INSTALL_RPATH "$ORIGIN")
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# -ffp-contract=off: a fused multiply-add rounds once where two operations round twice, and whether it is used depends on
# the machine and on the compiler's mood. Same seed, same bytes forbids it.
# -fno-math-errno: lets sqrt become one instruction; it changes no value.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 sees errors inside std::string that are not there (its bugs 105329 and 105562).
  add_compile_options(-Wno-restrict -Wno-maybe-uninitialized)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

if(SILVA_SANITIZE)
  add_compile_options(-fsanitize=${SILVA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SILVA_SANITIZE})
endif()

find_program(SILVA_CCACHE ccache)
if(SILVA_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SILVA_CCACHE})
endif()
