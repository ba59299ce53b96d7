# What every target of the project has in common: the language, the warnings, the arithmetic.

add_library(feldspar_settings INTERFACE)
target_compile_features(feldspar_settings INTERFACE cxx_std_20)
target_include_directories(feldspar_settings INTERFACE ${CMAKE_SOURCE_DIR})
# No fused multiply-add behind our back: the same source gives the same bits with every compiler and processor.
target_compile_options(feldspar_settings INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wshadow
  -Wno-psabi # vectors are handed over within one program only
  -fno-semantic-interposition) # calls within a shared library stay direct, and may be inlined
set(CMAKE_POSITION_INDEPENDENT_CODE ON) # the Python module links the same objects as the programs
# Eigen without its own vectors. With them the order of a sum depends on the processor and on where the numbers happen to
# lie; and alignment and allocator would differ from those of the distribution's libraries, whose functions are linked
# into the same program.
target_compile_definitions(feldspar_settings INTERFACE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_DONT_VECTORIZE)
if(FELDSPAR_LEVEL)
  target_compile_options(feldspar_settings INTERFACE -march=${FELDSPAR_LEVEL})
elseif(FELDSPAR_NATIVE)
  target_compile_options(feldspar_settings INTERFACE -march=native)
endif()
# GCC 12 warns of its own AVX-512 header (its bug 105593) where a vector square root is inlined.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(feldspar_settings INTERFACE -Wno-uninitialized)
endif()
# A unit that joins files includes the unnamed namespaces of all but one, whose names others may shadow.
target_compile_options(feldspar_settings INTERFACE
  $<$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>:-Wno-shadow$<SEMICOLON>$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>>)
if(FELDSPAR_WARNINGS_AS_ERRORS)
  target_compile_options(feldspar_settings INTERFACE -Werror)
endif()
if(FELDSPAR_SANITIZE)
  target_compile_options(feldspar_settings INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(FELDSPAR_SANITIZE STREQUAL "most")
    # A quarter of the time to compile, for mistakes that mostly end a program by themselves or by the address sanitizer.
    target_compile_options(feldspar_settings INTERFACE -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  target_link_options(feldspar_settings INTERFACE -fsanitize=address,undefined)
  # Where Eigen sees the address sanitizer it no longer trusts malloc's alignment, puts a pointer before each block, and
  # looks for it when the block is freed. Of the functions of Eigen that our units and Ceres both instantiate one serves
  # both, and Ceres takes blocks from malloc as they are.
  target_compile_definitions(feldspar_settings INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# Less optimisation, a quarter less time to compile, the same bits: for targets that lead runs and write results, whose own
# loops do not show beside those of dem/, fem/ and coupling/.
function(feldspar_optimise_lightly)
  foreach(name ${ARGN})
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# The settings are for building here, not part of what is installed.
function(feldspar_add_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC feldspar_settings)
endfunction()
