# HDF5 as deal.II links it: the OpenMPI build with its C++ interface, never the serial library that may lie beside it.
#   OpenMPIHDF5::OpenMPIHDF5

find_package(MPI REQUIRED COMPONENTS C)
find_path(OpenMPIHDF5_INCLUDE_DIR H5Cpp.h PATH_SUFFIXES hdf5/openmpi)
find_library(OpenMPIHDF5_LIBRARY hdf5_openmpi)
find_library(OpenMPIHDF5_CPP_LIBRARY hdf5_openmpi_cpp)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenMPIHDF5
  REQUIRED_VARS OpenMPIHDF5_LIBRARY OpenMPIHDF5_CPP_LIBRARY OpenMPIHDF5_INCLUDE_DIR)

if(OpenMPIHDF5_FOUND AND NOT TARGET OpenMPIHDF5::OpenMPIHDF5)
  add_library(OpenMPIHDF5::OpenMPIHDF5 INTERFACE IMPORTED)
  target_include_directories(OpenMPIHDF5::OpenMPIHDF5 SYSTEM INTERFACE ${OpenMPIHDF5_INCLUDE_DIR})
  target_link_libraries(OpenMPIHDF5::OpenMPIHDF5
    INTERFACE ${OpenMPIHDF5_CPP_LIBRARY} ${OpenMPIHDF5_LIBRARY} MPI::MPI_C)
endif()
