# The XDMF library in its OpenMPI build, which goes with our HDF5.
#   Xdmf::Xdmf

find_package(LibXml2 REQUIRED)
find_path(Xdmf_INCLUDE_DIR XdmfReader.hpp)
find_library(Xdmf_LIBRARY Xdmf PATH_SUFFIXES xdmf/openmpi)
find_library(Xdmf_CORE_LIBRARY XdmfCore PATH_SUFFIXES xdmf/openmpi)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Xdmf REQUIRED_VARS Xdmf_LIBRARY Xdmf_CORE_LIBRARY Xdmf_INCLUDE_DIR)

if(Xdmf_FOUND AND NOT TARGET Xdmf::Xdmf)
  add_library(Xdmf::Xdmf INTERFACE IMPORTED)
  target_include_directories(Xdmf::Xdmf SYSTEM INTERFACE ${Xdmf_INCLUDE_DIR})
  target_link_libraries(Xdmf::Xdmf
    INTERFACE ${Xdmf_LIBRARY} ${Xdmf_CORE_LIBRARY} LibXml2::LibXml2 OpenMPIHDF5::OpenMPIHDF5)
endif()
