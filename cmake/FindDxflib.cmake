# dxflib, which reads drawings in DXF. Debian's package has no CMake file. Defines
#   dxflib::dxflib

find_path(DXFLIB_INCLUDE_DIR dxflib/dl_dxf.h)
find_library(DXFLIB_LIBRARY dxflib)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Dxflib REQUIRED_VARS DXFLIB_LIBRARY DXFLIB_INCLUDE_DIR)

if(DXFLIB_FOUND AND NOT TARGET dxflib::dxflib)
  add_library(dxflib::dxflib UNKNOWN IMPORTED)
  set_target_properties(dxflib::dxflib PROPERTIES
    IMPORTED_LOCATION ${DXFLIB_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${DXFLIB_INCLUDE_DIR})
endif()
mark_as_advanced(DXFLIB_INCLUDE_DIR DXFLIB_LIBRARY)
