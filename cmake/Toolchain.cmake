set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)

# Assertions stay on in release: a render server would rather stop with a reason than draw nonsense.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g")

set(CUPOLA_SANITIZE "" CACHE STRING "Value of -fsanitize=, or empty")

# Pieces meet without a hole only if both sides of a border compute the same bits; a fused multiply-add on
# one side and not on the other would break that. So contraction is off everywhere.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wimplicit-fallthrough
                    -ffp-contract=off -fno-math-errno
                    -Wno-restrict) # g++ 12 sees overlaps in std::string that are none
if(CUPOLA_SANITIZE)
  add_compile_options(-fsanitize=${CUPOLA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=${CUPOLA_SANITIZE})
endif()

find_program(CUPOLA_MOLD mold)
if(CUPOLA_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

find_program(CUPOLA_CCACHE ccache)
if(CUPOLA_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CUPOLA_CCACHE})
endif()
